// Several pages, lost connections, foreign sites and malformed messages.
import assert from "node:assert/strict";
import { connect } from "node:net";
import { test } from "node:test";
import { assertSameBits, kPatience, openPage, openSession, pressAndWait, startProgram, steering, theBrowser, until } from "./harness.mjs";

const program = await startProgram("scenes/cantilever.toml");
// Messages of the browser about a broken connection, also during sending.
const kLostSocket = /WebSocket connection to .* failed|WebSocket is already in CLOSING or CLOSED state/;

test("steering passes between two pages", async () => {
  const one = await openSession(program);
  const two = await openSession(program, { watches: true });
  await two.page.getByText("Watching", { exact: true }).waitFor();
  await two.until("a button that does nothing", () => two.page.getByRole("button", { name: "Play", exact: true }).isDisabled());
  const before = two.heard.state.a.step;
  await pressAndWait(one, "s", "a step", () => two.heard.state.a.step === before + 1 && two.heard.pictures.a.step === before + 1 && one.heard.pictures.a.step === before + 1);
  assertSameBits(two.heard.pictures.a.positions, one.heard.pictures.a.positions);
  await two.page.keyboard.press("s"); // has no effect: the page only watches
  await two.page.getByRole("button", { name: "Steer", exact: true }).click();
  await one.page.getByText("Watching", { exact: true }).waitFor();
  await two.page.getByText("Watching", { exact: true }).waitFor({ state: "hidden" });
  assert.equal(one.heard.state.a.step, before + 1);
  await pressAndWait(two, "s", "a step of the other", () => one.heard.state.a.step === before + 2);
  await two.close();
  await one.page.getByText("Watching", { exact: true }).waitFor({ state: "hidden" });
  await pressAndWait(one, "s", "a step", () => one.heard.state.a.step === before + 3);
  await one.close();
});

test("closing a steering page releases the body", async () => {
  const one = await openSession(program);
  const two = await openSession(program, { watches: true });
  const grab = { do: "grab", side: "a", triangle: 0, weights: [1, 0, 0], target: [0.5, 0.5, 0.5] };
  const three = await openPage(program.address, {
    prepare: (page) =>
      page.addInitScript(() => {
        window.sockets = [];
        window.WebSocket = class extends WebSocket {
          constructor(...args) {
            super(...args);
            window.sockets.push(this);
          }
        };
      }),
  });
  await three.until("a picture", ({ pictures }) => pictures.a);
  await three.page.getByRole("button", { name: "Steer", exact: true }).click();
  await one.until("watching", ({ messages }) => messages.some(({ kind, steers }) => kind === "role" && !steers));
  await three.page.evaluate((command) => window.sockets[0].send(JSON.stringify(command)), grab);
  await one.until("a grab", ({ state }) => state.a.grab);
  await three.close();
  await one.until("a release", ({ state }) => state.a.grab === null);
  await two.close();
  await one.close();
});

test("a wrong token is refused", async () => {
  const page = await (await theBrowser()).newPage();
  page.setDefaultTimeout(kPatience);
  const { origin } = new URL(program.address);
  for (const address of [origin, `${origin}/?token=wrong`, `${program.address}x`]) {
    const response = await page.goto(address);
    assert.equal(response.status(), 403);
    assert.match(await page.innerText("body"), /token/);
  }
  const opens = (address) =>
    page.evaluate((to) => new Promise((done) => {
      const socket = new WebSocket(to);
      socket.onopen = () => done(true);
      socket.onerror = () => done(false);
    }), address);
  assert.equal(await opens(`${origin.replace("http", "ws")}/session?token=wrong`), false);
  // Another site, even with the token.
  await page.route("http://elsewhere.test/", (route) => route.fulfill({ contentType: "text/html", body: "elsewhere" }));
  await page.goto("http://elsewhere.test/");
  assert.equal(await opens(program.address.replace("http", "ws").replace("/?", "/session?")), false);
  await page.context().close();
});

test("malformed messages are refused, pages continue", async () => {
  const one = await openSession(program);
  const two = await openPage(program.address, { prepare: (page) => page.addInitScript(() => {
    const Native = WebSocket;
    window.WebSocket = function (...args) { return (window.socket = new Native(...args)); };
  }) });
  await two.until("a picture", ({ pictures }) => pictures.a);
  await two.page.getByRole("button", { name: "Steer", exact: true }).click();
  await one.page.getByText("Watching", { exact: true }).waitFor();
  const nonsense = [
    "", "{", "null", "[]", "42", '"do"', "{}", '{"do":"nothing"}', '{"do":7}', '{"do":"set"}', '{"id":1e300,"do":"play","do":"pause"}',
    '{"do":"set","key":"time.step","value":{}}', '{"do":"set","key":"../etc","value":1}',
    '{"do":"grab","side":"c","triangle":0,"weights":[1,0,0],"target":[0,0,0]}',
    '{"do":"grab","side":"a","triangle":99999999,"weights":[1,0,0],"target":[0,0,0]}',
    '{"do":"grab","side":"a","triangle":-1,"weights":[1,0,0],"target":[0,0,0]}',
    '{"do":"grab","side":"a","triangle":0,"weights":[1e308,1e308,0],"target":[1e308,0,0]}',
    '{"do":"pin","side":"a","vertices":[-1,1e9],"pinned":true}', '{"do":"pin","side":"a","vertices":"all","pinned":1}',
    '{"do":"rewind","step":-5}', '{"do":"rewind","step":1e12}', '{"do":"speed","value":-1}', '{"do":"stiffness","value":1e999}',
    '{"do":"load","scene":"/etc/passwd"}', '{"do":"load","scene":"/dev/zero"}', '{"do":"lesson","lesson":"none"}',
    '{"do":"compare","overrides":["x"],"label":"B"}', '{"do":"replay","recording":{}}', '{"do":"replay","recording":{"scene":"x","events":[1],"steps":1e18}}',
    '{"ask":"vertex","id":1}', '{"ask":"vertex","id":2,"side":"a","vertex":1e9}', '{"ask":"mesh","id":3,"side":"a","format":"exe"}',
    '{"ask":"function","id":4,"name":"sin(","start":[0,0],"settings":{},"iteration":0,"samples":11}',
    '{"ask":"iteration","id":5,"side":"a","step":7000000,"iteration":0}', "[".repeat(100000), `{"do":"${"x".repeat(100000)}"}`,
    "\u0000\uffff", '{"do":"color","field":"none such"}', '{"do":"surface","which":"skull"}',
  ];
  const answers = () => two.heard.messages.filter(({ kind }) => kind === "refused").length;
  for (const text of nonsense) {
    const before = answers();
    await two.page.evaluate((message) => window.socket.send(message), text);
    await until(`a refusal of ${text.slice(0, 60)}`, () => answers() > before, () => JSON.stringify(two.heard.messages.at(-1)).slice(0, 300));
    assert.ok(two.heard.messages.findLast(({ kind }) => kind === "refused").why.length > 10);
  }
  await two.page.evaluate(() => window.socket.send(new Uint8Array([1, 2, 3, 4])));
  assert.deepEqual(two.errors.filter((error) => !kLostSocket.test(error)), []);
  await two.page.context().close();
  await one.page.getByText("Watching", { exact: true }).waitFor({ state: "hidden" });
  const { step } = one.heard.state.a;
  await pressAndWait(one, "s", "a step", () => one.heard.state.a.step === step + 1);
  await until("a word about it", () => /refused/.test(program.complained), () => program.complained);
  await one.close();
});

test("malformed HTTP requests do not stop the server", async () => {
  const { hostname, port, search } = new URL(program.address);
  const request = (text) => new Promise((resolve) => {
    let heard = "";
    const socket = connect(Number(port), hostname, () => socket.write(text));
    socket.on("data", (chunk) => (heard += chunk));
    socket.on("close", () => resolve(heard));
    socket.on("error", () => resolve(heard));
  });
  assert.match(await request("nonsense\r\n\r\n"), /^HTTP\/1.1 400|^$/);
  assert.match(await request(`GET /${search} HTTP/1.1\r\nHost: evil.test:${port}\r\n\r\n`), /^HTTP\/1.1 403/);
  assert.match(await request(`GET /${search} HTTP/1.1\r\nHost: 127.0.0.1:${port}\r\nX: ${"x".repeat(100000)}\r\n\r\n`), /^HTTP\/1.1 431|^$/);
  assert.match(await request(`GET /../../etc/passwd${search} HTTP/1.1\r\nHost: 127.0.0.1:${port}\r\n\r\n`), /^HTTP\/1.1 40[034]/);
  const one = await openSession(program);
  await one.close();
});

test("a dropped connection is restored with its state", async () => {
  let isCut = false;
  const links = [];
  const opened = await openPage(program.address, { expected: kLostSocket, prepare: (page) =>
    page.routeWebSocket(/\/session/, (socket) => {
      if (isCut) return socket.close();
      links.push({ socket, server: socket.connectToServer() });
    }) });
  const { page, close } = opened;
  await page.locator("#views canvas").first().waitFor();
  await page.locator(".place").filter({ hasText: /^step/ }).waitFor();
  const place = () => page.locator(".place").innerText();
  const steers = () => until("the steering", () => page.getByRole("button", { name: "Step", exact: true }).isEnabled());
  await steers();
  await page.keyboard.press("s");
  await page.locator(".place").filter({ hasText: /^step 1, [\d.]+ s$/ }).waitFor();
  const known = await place();
  isCut = true;
  await links[0].server.close();
  await links[0].socket.close();
  await page.getByText("Connection lost").waitFor();
  isCut = false;
  await until("another connection", () => links.length > 1);
  await page.locator(".lasting").waitFor({ state: "hidden" });
  assert.equal(await place(), known);
  await steers();
  await page.keyboard.press("s");
  await page.waitForFunction((before) => document.querySelector(".place").textContent !== before, known);
  await close();
});

test("the end of the program is reported", async () => {
  const another = await startProgram("scenes/cantilever.toml");
  const opened = await openSession(another, { expected: /ERR_CONNECTION_REFUSED|WebSocket connection/ });
  assert.equal(await another.end(), 0, another.complained);
  await opened.page.locator(".lasting.error").filter({ hasText: /Connection lost|ended/ }).waitFor();
  await opened.page.getByText(/start aspic view again/).waitFor();
  await opened.close();
});
