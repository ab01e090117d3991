// Looks at a domain through `skein view` as Foxglove's own client does: foxglove_client.js SKEIN STAGE VENDOR.
"use strict";

const assert = require("assert");
const { spawn } = require("child_process");
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { parseIDL } = require("@foxglove/omgidl-parser");
const { MessageReader } = require("@foxglove/omgidl-serialization");
const WebSocket = require("ws");

const [skein, stageProgram, vendor] = process.argv.slice(2);
const domain = "31";
const patience = 60_000; // that only a broken program exhausts

setTimeout(() => {
  console.error("it has taken too long; seen so far:", JSON.stringify(seen, plain, 1).slice(0, 5000));
  process.exit(1);
}, patience).unref();

// What the server has said, as a client keeps it.
const seen = { channels: new Map(), services: new Map(), graph: { published: {}, subscribed: {}, services: {} }, statuses: [] };
const waiting = new Set();

function plain(_key, value) {
  if (value instanceof Map) return Object.fromEntries(value);
  return typeof value === "bigint" ? Number(value) : value;
}

// The first thing that `find` finds, now or when the server has said more.
function until(find) {
  return new Promise((resolve, reject) => {
    const look = () => {
      try {
        const found = find();
        if (!found) return;
        waiting.delete(look);
        resolve(found);
      } catch (error) {
        reject(error);
      }
    };
    waiting.add(look);
    look();
  });
}

function note(change) {
  return (message) => {
    change(message);
    for (const look of [...waiting]) look();
  };
}

function keep(client) {
  client.on("error", (error) => { throw error; });
  client.on("serverInfo", note((info) => { seen.info = info; }));
  client.on("status", note((status) => seen.statuses.push(status)));
  client.on("advertise", note((channels) => channels.forEach((each) => seen.channels.set(each.topic, each))));
  client.on("unadvertise", note((ids) => remove(seen.channels, ids)));
  client.on("advertiseServices", note((services) => services.forEach((each) => seen.services.set(each.name, each))));
  client.on("unadvertiseServices", note((ids) => remove(seen.services, ids)));
  client.on("connectionGraphUpdate", note((update) => {
    for (const { name, publisherIds } of update.publishedTopics) seen.graph.published[name] = publisherIds;
    for (const { name, subscriberIds } of update.subscribedTopics) seen.graph.subscribed[name] = subscriberIds;
    for (const { name, providerIds } of update.advertisedServices) seen.graph.services[name] = providerIds;
    for (const name of update.removedTopics) {
      delete seen.graph.published[name];
      delete seen.graph.subscribed[name];
    }
    for (const name of update.removedServices) delete seen.graph.services[name];
  }));
  for (const event of ["serviceCallResponse", "serviceCallFailure"]) client.on(event, note((answer) => { seen.answer = answer; }));
}

function remove(map, ids) {
  for (const [name, { id }] of map) if (ids.includes(id)) map.delete(name);
}

// Subscribes to a topic, and decodes its messages by the schema that the server gave.
async function watch(client, topic) {
  const channel = await until(() => seen.channels.get(topic));
  assert.equal(channel.encoding, "cdr");
  assert.equal(channel.schemaEncoding, "omgidl");
  const reader = new MessageReader(channel.schemaName, parseIDL(channel.schema));
  const messages = [];
  const id = client.subscribe(channel.id);
  client.on("message", note(({ subscriptionId, timestamp, data }) => {
    if (subscriptionId === id) messages.push({ timestamp, value: reader.readMessage(data) });
  }));
  return { id, messages };
}

async function call(client, name, request) {
  const service = await until(() => seen.services.get(name));
  seen.answer = undefined;
  const data = new TextEncoder().encode(JSON.stringify(request));
  client.sendServiceCallRequest({ serviceId: service.id, callId: 7, encoding: "json", data });
  const answer = await until(() => seen.answer);
  assert.equal(answer.callId, 7);
  return answer.data ? JSON.parse(new TextDecoder().decode(answer.data)) : answer.message;
}

function start(program, ...parameters) {
  const child = spawn(program, parameters, { stdio: ["pipe", "pipe", "inherit"] });
  child.output = "";
  child.stdout.on("data", note((text) => { child.output += text; }));
  process.on("exit", () => child.kill());
  return child;
}

// The HTTP status by which a handshake is refused.
function refusal(url) {
  return new Promise((resolve, reject) => {
    const socket = new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
    socket.on("unexpected-response", (_request, response) => resolve(response.statusCode));
    socket.on("open", () => reject(new Error(`${url} was let in`)));
    socket.on("error", reject);
  });
}

async function main() {
  const stage = start(stageProgram, vendor, domain);
  const view = start(skein, "view", "--calls", "--port", "0", "--domain", domain);
  const url = (await until(() => view.output.match(/^ws:\S+$/m)))[0];

  assert.equal(await refusal(url.replace(/token=./, "token=_")), 401);

  const socket = new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL, "foxglove.sdk.v1"]);
  const client = new FoxgloveClient({ ws: socket });
  keep(client);
  await until(() => seen.info);
  assert.deepEqual(seen.info.capabilities.sort(), ["connectionGraph", "services"]);
  assert.deepEqual(seen.info.supportedEncodings, ["json"]);
  assert.ok(seen.info.sessionId);

  // Topics of the mission, by their own types; what was published before anybody looked, too.
  const poses = await watch(client, "site/pose");
  await until(() => poses.messages.length >= 10);
  const [first, second] = poses.messages;
  assert.deepEqual(first.value.position, { x: 1.5, y: -2.5 });
  assert.deepEqual(first.value.trail, [{ x: 1, y: 2 }, { x: 3, y: 4 }]);
  assert.equal(first.value.remark, "über den Wolken");
  assert.ok(second.value.number > first.value.number);
  assert.ok(second.timestamp >= first.timestamp);
  const modes = await watch(client, "site/mode");
  await until(() => modes.messages.length >= 1);
  assert.deepEqual(modes.messages[0].value, { vehicle: "uav-1", phase: 1 });

  // Skein's own topics, of which the statistics are told every second.
  for (const topic of ["skein/calls", "skein/decisions"]) await watch(client, topic);
  const statistics = await watch(client, "skein/statistics");
  await until(() => statistics.messages.some(({ value }) => value.service === "stage/ICalculator"));

  // Who publishes, subscribes and provides what.
  client.subscribeConnectionGraph();
  await until(() => seen.graph.published["site/pose"]?.includes("site/stage"));
  await until(() => seen.graph.subscribed["site/command"]?.includes("site/stage"));
  await until(() => seen.graph.services["stage/ICalculator"]?.includes("site/stage"));

  // Calls.
  assert.deepEqual(await call(client, "site/stage/stage::ICalculator.add", { a: 1, b: 2 }), { return_: 3 });
  assert.match(await call(client, "site/stage/stage::ICalculator.fail", {}), /stage::Broken.*the seventh gear/);
  assert.match(await call(client, "site/stage/stage::ICalculator.add", { a: 1 }), /'b'/);

  // What the server does not offer.
  client.getParameters([]);
  await until(() => seen.statuses.some(({ level, message }) => level === 2 && message.includes("getParameters")));

  // What has ended is taken away.
  client.unsubscribe(poses.id);
  stage.stdin.end();
  await until(() => !seen.channels.has("site/pose") && !seen.channels.has("site/mode"));
  await until(() => ![...seen.services.keys()].some((name) => name.includes("ICalculator")));
  await until(() => !seen.graph.published["site/pose"] && !seen.graph.services["stage/ICalculator"]);
  assert.ok(seen.channels.has("skein/calls"));

  const code = new Promise((resolve) => { view.on("exit", resolve); });
  view.kill("SIGINT");
  assert.equal(await code, 0);
  console.log("all is well");
}

main().then(() => process.exit(0), (error) => {
  console.error(error);
  process.exit(1);
});
