// Source of messages: a running simulation at the other end of a transport. Pairs requests with their replies.
import { decode } from "./protocol";
import type { Command, Query, ServerMessage } from "./protocol";
import { Refusal, type Incoming, type Source } from "./source";

export interface TransportListener {
  opened(): void;
  received(data: string | ArrayBuffer): void;
  closed(why: string, failures: number): void; // failures: failed connections in a row
}

// Connection to a program: a WebSocket, or a worker that runs the engine.
export interface Transport {
  start(listener: TransportListener): void;
  send(text: string): boolean; // false: there is no connection
}

interface Pending {
  resolve: (reply: unknown) => void;
  reject: (reason: Error) => void;
}

export class LiveSource implements Source {
  readonly live = true;
  private receive: (incoming: Incoming) => void = () => {};
  private readonly pending = new Map<number, Pending>();
  private lastId = 0;

  constructor(private readonly transport: Transport) {}

  start(receive: (incoming: Incoming) => void): void {
    this.receive = receive;
    this.transport.start({
      opened: () => receive({ failures: 0 }),
      received: (data) => this.take(data),
      closed: (why, failures) => this.lost(why, failures),
    });
  }

  send(command: Command): void {
    if (!this.transport.send(JSON.stringify(command))) this.refuse("there is no connection to the program");
  }

  request(command: Command): Promise<unknown> {
    return this.exchange(command);
  }

  ask<Reply>(query: Query): Promise<Reply> {
    return this.exchange(query) as Promise<Reply>;
  }

  ready(): void {
    this.transport.send("ready");
  }

  private lost(why: string, failures: number): void {
    if (why) this.refuse(`The program closed the connection: ${why}`);
    for (const { reject } of this.pending.values()) reject(new Error("the connection to the program was lost"));
    this.pending.clear();
    this.receive({ failures });
  }

  private take(data: string | ArrayBuffer): void {
    if (typeof data !== "string") return this.receive(decode(data));
    const message = JSON.parse(data) as ServerMessage;
    const isAnswer = message.kind === "reply" || message.kind === "refused";
    const asked = isAnswer && message.id !== null ? this.pending.get(message.id) : undefined;
    if (!isAnswer || !asked) return this.receive({ message });
    this.pending.delete(message.id as number);
    if (message.kind === "reply") asked.resolve(message.reply);
    else asked.reject(new Refusal(message.why, message.interrupted === true));
  }

  private exchange(message: Command | Query): Promise<unknown> {
    const id = ++this.lastId;
    return new Promise((resolve, reject) => {
      if (this.transport.send(JSON.stringify({ ...message, id }))) this.pending.set(id, { resolve, reject });
      else reject(new Error("there is no connection to the program"));
    });
  }

  private refuse(why: string): void {
    this.receive({ message: { kind: "refused", id: null, why } });
  }
}
