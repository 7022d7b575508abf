// Source of messages: a running simulation at the other end of a WebSocket. After a lost connection it reconnects, and
// the program sends the complete state again.
import { decode } from "./protocol";
import type { Command, Query, ServerMessage } from "./protocol";
import type { Incoming, Source } from "./source";

export type Socket = Pick<
  WebSocket,
  "binaryType" | "readyState" | "send" | "close" | "onopen" | "onmessage" | "onclose"
>;

interface Pending {
  resolve: (reply: unknown) => void;
  reject: (reason: Error) => void;
}

const kOpen = 1;
const kFirstPause = 250; // first pause before a reconnection [ms]; doubled after each failure
const kLongestPause = 5000;

export class LiveSource implements Source {
  readonly live = true;
  failures = 0; // failed reconnections since the connection was lost
  private socket: Socket | null = null;
  private receive: (incoming: Incoming) => void = () => {};
  private readonly pending = new Map<number, Pending>();
  private lastId = 0;

  constructor(
    private readonly address: string,
    private readonly open: (address: string) => Socket = (address) => new WebSocket(address),
  ) {}

  start(receive: (incoming: Incoming) => void): void {
    this.receive = receive;
    this.connect();
  }

  send(command: Command): void {
    if (!this.transmit(JSON.stringify(command))) this.refuse("there is no connection to the program");
  }

  request(command: Command): Promise<unknown> {
    return this.exchange(command);
  }

  ask<Reply>(query: Query): Promise<Reply> {
    return this.exchange(query) as Promise<Reply>;
  }

  ready(): void {
    this.transmit("ready");
  }

  private connect(): void {
    const socket = this.open(this.address);
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.failures = 0;
      this.receive({ connected: true });
    };
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => this.take(event.data);
    socket.onclose = (event) => this.lost(event.reason);
  }

  private lost(why: string): void {
    if (why) this.refuse(`The program closed the connection: ${why}`);
    for (const { reject } of this.pending.values()) reject(new Error("the connection to the program was lost"));
    this.pending.clear();
    this.failures += 1;
    this.receive({ connected: false });
    setTimeout(() => this.connect(), Math.min(kFirstPause * 2 ** (this.failures - 1), kLongestPause));
  }

  private take(data: string | ArrayBuffer): void {
    if (typeof data !== "string") return this.receive(decode(data));
    const message = JSON.parse(data) as ServerMessage;
    if (message.kind !== "reply" && message.kind !== "refused") return this.receive({ message });
    const asked = message.id === null ? undefined : this.pending.get(message.id);
    if (!asked) return this.receive({ message });
    this.pending.delete(message.id as number);
    if (message.kind === "reply") asked.resolve(message.reply);
    else asked.reject(new Error(message.why));
  }

  private exchange(message: Command | Query): Promise<unknown> {
    const id = ++this.lastId;
    return new Promise((resolve, reject) => {
      this.pending.set(id, { resolve, reject });
      if (this.transmit(JSON.stringify({ ...message, id }))) return;
      this.pending.delete(id);
      reject(new Error("there is no connection to the program"));
    });
  }

  private transmit(text: string): boolean {
    if (this.socket?.readyState !== kOpen) return false;
    this.socket.send(text);
    return true;
  }

  private refuse(why: string): void {
    this.receive({ message: { kind: "refused", id: null, why } });
  }
}

const kTokenKey = "aspic.token";

// Address of the session. Removes the token from the visible address, so that a projected page does not reveal it. The
// tab keeps the token for a reload.
export function sessionAddress(): string {
  const here = new URL(location.href);
  let token = here.searchParams.get("token");
  try {
    if (token) sessionStorage.setItem(kTokenKey, token);
    else token = sessionStorage.getItem(kTokenKey);
    here.searchParams.delete("token");
    history.replaceState(null, "", here);
  } catch {
    // Without storage the token remains in the address for a reload.
  }
  const scheme = here.protocol === "https:" ? "wss:" : "ws:";
  return `${scheme}//${here.host}/session?token=${encodeURIComponent(token ?? "")}`;
}
