// Connection to the program of a page without a reader, which draws pictures: apps/viewer/browser_pictures.h.
import { messageOf } from "./dom";

export type Send = (path: "/count" | "/frame" | "/part", body: Blob | string) => Promise<Response>;

async function send(path: string, token: string, body: Blob | string): Promise<Response> {
  const answer = await fetch(`${path}?token=${encodeURIComponent(token)}`, { method: "POST", body });
  if (!answer.ok) throw new Error(await answer.text());
  return answer;
}

// Draws, and reports the result to the program.
export async function drawForProgram(draw: (query: URLSearchParams, send: Send) => Promise<void>): Promise<void> {
  const query = new URL(location.href).searchParams;
  const token = query.get("token") ?? "";
  try {
    await draw(query, (path, body) => send(path, token, body));
    await send("/end", token, "");
  } catch (error) {
    await send("/failed", token, messageOf(error));
  }
}
