// Where messages come from: a program that simulates (live.ts) or a recorded run inside the page (recorded.ts). Panels
// do not know which.
import type { Command, Geometry, Picture, Query, ServerMessage } from "./protocol";

export type Incoming = { message: ServerMessage } | { geometry: Geometry } | { picture: Picture } | { connected: boolean };

export interface Source {
  readonly live: boolean;
  start(receive: (incoming: Incoming) => void): void;
  send(command: Command): void; // what the source cannot do is answered by a `refused`
  request(command: Command): Promise<unknown>; // the same; resolves when it is done, rejects with the reason
  ask<Reply>(query: Query): Promise<Reply>; // rejects with the reason
  ready(): void; // the last picture is drawn; the next may come
}
