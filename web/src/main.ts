// The page: one source of messages, one store, and panels that subscribe to it.
import { GUI } from "lil-gui";
import "./style.css";
import "./shell.css";
import { makeCompareButton } from "./compare";
import { Dock } from "./dock";
import { embeddedEngine, hasEngine } from "./engine";
import { Files } from "./files";
import { extensions } from "./extensions";
import { Lecture } from "./lecture";
import { makeInvitation } from "./invitation";
import { LiveSource } from "./live";
import { drawMeshPictures } from "./meshPicture";
import { showNotices, showOwnErrors } from "./notices";
import { embedded } from "./pack";
import { Page } from "./page";
import type { Panel } from "./page";
import { addDisplayControls } from "./panels/display";
import { EnergyPanel } from "./panels/energy";
import { FunctionsPanel } from "./panels/functions";
import { LandscapePanel } from "./panels/landscape";
import { makeMeshError } from "./panels/meshError";
import { MicroscopePanel } from "./panels/microscope";
import { makeReportPanel } from "./panels/report";
import { Settings } from "./panels/settings";
import { Chosen } from "./plots/chosen";
import { registerColors } from "./plots/palette";
import { drawForProgram } from "./program";
import { RecordedSource } from "./recorded";
import { renderPictures } from "./render";
import { makeRole } from "./role";
import { Sharing } from "./share";
import { listenToKeys } from "./shortcuts";
import { Sidebar } from "./sidebar";
import { overSocket, sessionAddress } from "./socket";
import type { Source } from "./source";
import { Store } from "./store";
import { Theme } from "./theme";
import { makeToolbar } from "./toolbar";
import { makeScreenshotButton, Video } from "./video";
import { Display } from "./view/display";
import { Views } from "./views";

function area(id: string): HTMLElement {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found;
}

// `sharing`: null without an engine.
function buildPage(store: Store, page: Page, sharing: Sharing | null): void {
  if (!store.source.live) area("messages").append(makeMeshError(store, page));
  showNotices(area("messages"), store, page);
  const theme = new Theme(page);
  const display = new Display();
  suitScenes(store, display);
  if (store.source instanceof RecordedSource) suitFigures(store.source, store);
  const views = new Views(area("views"), store, page, display);
  const functions = new FunctionsPanel(store, page);
  const chosen = new Chosen(store, page);
  const panels: Panel[] = [new EnergyPanel(store, page), new MicroscopePanel(store, page, chosen)];
  if (store.source.live) panels.push(new LandscapePanel(store, page, chosen), functions);
  panels.push(makeReportPanel(store, page));
  let dock: Dock;
  if (store.source.live) for (const extension of extensions) extension.addTo(store, page, display, () => dock);
  const besideSettings = query.has("settings"); // in a notebook
  const sidebar = new Sidebar(area("right"), page, !besideSettings);
  addDisplayControls(new GUI({ container: sidebar.body, title: "View" }).open(!besideSettings), display, store, page, views.all);
  new Settings(sidebar.body, store, page);
  dock = new Dock(area("dock"), page, panels);
  const lecture = new Lecture(area("left"), store, page, (question) => functions.open(question));
  const video = new Video(store, page, views.draw);
  area("views").append(video.indicator);
  const files = new Files(store, page, video, sharing, (side) => display.camera(side)).makeMenu([makeScreenshotButton(store, page, views.draw), video.opener]);
  const live = store.source.live ? [makeCompareButton(store, page), lecture.opener] : [];
  makeToolbar(area("toolbar"), store, page, theme, [makeRole(store), ...live, files, sidebar.opener]);
  listenToKeys(page);
}

// Wires and pins hide fibres, so scenes with fibres open without them.
function suitScenes(store: Store, display: Display): void {
  let withFibres = ""; // name of the scene
  const suit = (name: string): void => {
    if ((withFibres !== "") !== (name !== "")) display.change({ wires: name === "", pins: name === "" });
    withFibres = name;
  };
  store.on("fibres", () => store.name !== withFibres && suit(store.name));
  store.on("scene", (side) => side === "a" && store.name !== withFibres && withFibres !== "" && suit(""));
}

// A figure of arrays hides what belongs to simulations.
function suitFigures(source: RecordedSource, store: Store): void {
  store.on("scene", () => {
    document.body.classList.toggle("of-arrays", source.isFigure);
    document.body.classList.toggle("still", source.isFigure && source.frames.step.length === 1);
  });
}

function openPage(source: Source, html: string | null = null): void {
  const page = new Page();
  showOwnErrors(page);
  const store = new Store(source);
  const sharing = html === null ? null : new Sharing(html, store, page);
  buildPage(store, page, sharing);
  const stop = store.on("role", () => {
    stop();
    void sharing?.open().catch(page.report);
  });
  store.start();
}

function openLive(): void {
  if (hasEngine()) {
    openPage(new LiveSource(embeddedEngine()), `<!doctype html>\n${document.documentElement.outerHTML}`);
  } else openPage(new LiveSource(overSocket(sessionAddress())));
  if (location.hash === "") area("views").append(makeInvitation());
}

registerColors();
const extension = extensions.find(({ document }) => embedded(document.id) !== null);
const query = new URL(location.href).searchParams;
const recording = embedded("recording");
if (query.has("meshes")) void drawForProgram(drawMeshPictures);
else if (extension) void extension.document.open(embedded(extension.document.id)!);
else if (recording === null) openLive();
else if (query.has("render")) void drawForProgram(renderPictures(new RecordedSource(recording)));
else openPage(new RecordedSource(recording));
