// Source of messages: a running program (live.ts, over socket.ts or engine.ts) or a recorded run inside the page
// (recorded.ts). Panels do not depend on which.
import type { Command, Geometry, Picture, Query, ServerMessage } from "./protocol";

// failures: failed connections in a row; 0: connected; Infinity: the program has ended for good
export type Incoming = { message: ServerMessage } | { geometry: Geometry } | { picture: Picture } | { failures: number };

// The program has refused a command or a query.
export class Refusal extends Error {
  constructor(
    why: string,
    readonly isInterrupted: boolean, // by a command; a query may be repeated
  ) {
    super(why);
  }
}

export interface Source {
  readonly live: boolean;
  readonly largestPressure?: number; // of the contact points in all frames of a recorded run [Pa]
  start(receive: (incoming: Incoming) => void): void;
  send(command: Command): void; // answered by `refused` if the source cannot execute it
  request(command: Command): Promise<unknown>; // resolves on completion, rejects with the reason
  ask<Reply>(query: Query): Promise<Reply>; // rejects with the reason
  ready(): void; // call after drawing the last picture; the next may come
}
