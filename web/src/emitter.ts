// Typed events by name.
export class Emitter<Events> {
  private readonly listeners = new Map<keyof Events, Set<(event: never) => void>>();

  // Calls the listener for every event until the signal aborts, or until the returned function is called.
  on<K extends keyof Events>(name: K, listener: (event: Events[K]) => void, signal?: AbortSignal): () => void {
    const set = this.listeners.get(name) ?? new Set();
    this.listeners.set(name, set.add(listener));
    const stop = (): void => void set.delete(listener);
    signal?.addEventListener("abort", stop);
    return stop;
  }

  emit<K extends keyof Events>(name: K, event: Events[K]): void {
    for (const listener of this.listeners.get(name) ?? []) (listener as (event: Events[K]) => void)(event);
  }
}
