// Links and pages that open with a workspace. Only a page with an engine has them: its scenes are the same everywhere.
import { saveFile, fileName } from "./dom";
import { embedded } from "./pack";
import type { Page } from "./page";
import type { Store } from "./store";
import { base64Of, bytesThrough } from "./upload";
import { openWorkspace, parseWorkspace, type Workspace, workspaceOf } from "./workspace";

const kPrefix = "#s=";
const kLongestLink = 8000; // characters; longer ones break in mail and chat programs
const kMostUnpacked = 1e6; // bytes of an unpacked link, whose author is unknown
const kElement = "workspace";

export async function linkText(workspace: Workspace): Promise<string> {
  const packed = await bytesThrough(new CompressionStream("deflate-raw"), new TextEncoder().encode(JSON.stringify(workspace)));
  return kPrefix + base64Of(packed).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

// Null: the address has no workspace. Rejects with a message if it is damaged.
export async function workspaceOfLink(hash: string): Promise<Workspace | null> {
  if (!hash.startsWith(kPrefix)) return null;
  let text: string;
  try {
    const base64 = hash.slice(kPrefix.length).replaceAll("-", "+").replaceAll("_", "/");
    const packed = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
    text = new TextDecoder("utf-8", { fatal: true }).decode(await bytesThrough(new DecompressionStream("deflate-raw"), packed, kMostUnpacked));
  } catch (reason) {
    if (reason instanceof RangeError) throw new Error(`The link contains more than ${kMostUnpacked / 1e6} MB, too much for a workspace.`);
    throw new Error("The link is damaged or incomplete. Copy all of it, to the last character.");
  }
  return parseWorkspace(text);
}

// The page of `html`, opening with the workspace instead of an earlier one.
export function pageText(html: string, workspace: Workspace): string {
  const json = JSON.stringify(JSON.stringify(workspace)).replaceAll("<", "\\u003c");
  const bare = html.replace(new RegExp(`<script type="application/json" id="${kElement}">.*?</script>`, "s"), "");
  const element = `<script type="application/json" id="${kElement}">${json}</script>`;
  return bare.replace('<script type="application/json" id="engine">', (engine) => element + engine);
}

export class Sharing {
  // `html`: the page before its scripts have changed it.
  constructor(
    private readonly html: string,
    private readonly store: Store,
    private readonly page: Page,
  ) {}

  // Opens the workspace of the address, now and whenever it changes, or else that of the page.
  async open(): Promise<void> {
    addEventListener("hashchange", () => void this.openLink().catch(this.page.report));
    if (await this.openLink()) return;
    const saved = embedded(kElement);
    if (saved !== null) await openWorkspace(parseWorkspace(saved), this.store, this.page);
  }

  private async openLink(): Promise<boolean> {
    const workspace = await workspaceOfLink(location.hash);
    if (workspace) await openWorkspace(workspace, this.store, this.page);
    return workspace !== null;
  }

  async copyLink(): Promise<void> {
    const text = await linkText(await workspaceOf(this.store, this.page, (scene) => scene.startsWith("/scenes/")));
    if (text.length > kLongestLink)
      throw new Error(`The link would have ${text.length} characters, too many for mail and chat programs. Save the page as one file instead.`);
    const address = location.href.replace(/#.*/, "") + text;
    history.replaceState(null, "", address);
    const isCopied = await navigator.clipboard.writeText(address).then(() => true, () => false);
    this.page.notice(isCopied ? "The link is copied." : "The link is in the address bar; copy it from there.");
  }

  async savePage(): Promise<void> {
    const workspace = await workspaceOf(this.store, this.page);
    saveFile(fileName(this.store.name, "html"), new Blob([pageText(this.html, workspace)], { type: "text/html" }));
  }
}
