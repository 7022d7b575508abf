// Limits a fast sequence of values to one request at a time: sends the newest and drops those in between.
export class Newest<Value> {
  private waiting: { value: Value } | null = null;
  private sending = false;

  constructor(
    private readonly send: (value: Value) => Promise<unknown>,
    private readonly failed: (reason: unknown) => void = () => {},
    private readonly done: () => void = () => {}, // called when no request is under way any more
  ) {}

  get busy(): boolean {
    return this.sending;
  }

  push(value: Value): void {
    this.waiting = { value };
    if (!this.sending) void this.drain();
  }

  private async drain(): Promise<void> {
    this.sending = true;
    while (this.waiting) {
      const { value } = this.waiting;
      this.waiting = null;
      try {
        await this.send(value);
      } catch (reason) {
        this.failed(reason);
      }
    }
    this.sending = false;
    this.done();
  }
}
