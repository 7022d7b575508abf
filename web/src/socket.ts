// Transport of messages over a WebSocket. After a lost connection it reconnects, and the program sends the complete state
// again.
import type { Transport, TransportListener } from "./live";

export type Socket = Pick<WebSocket, "binaryType" | "readyState" | "send" | "close" | "onopen" | "onmessage" | "onclose">;

const kOpen = 1;
const kFirstPause = 250; // first pause before a reconnection [ms]; doubled after each failure
const kLongestPause = 5000;
const kTokenKey = "aspic.token";

export function overSocket(address: string, open: (address: string) => Socket = (address) => new WebSocket(address)): Transport {
  let socket: Socket | null = null;
  let failures = 0; // failed connections in a row
  const start = (listener: TransportListener): void => {
    socket = open(address);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      failures = 0;
      listener.opened();
    };
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => listener.received(data);
    socket.onclose = ({ reason }) => {
      listener.closed(reason, ++failures);
      setTimeout(() => start(listener), Math.min(kFirstPause * 2 ** (failures - 1), kLongestPause));
    };
  };
  const send = (text: string): boolean => {
    if (socket?.readyState !== kOpen) return false;
    socket.send(text);
    return true;
  };
  return { start, send };
}

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
