// Runs a flow in a headless Node-RED: node flow.cjs FOLDER FLOW. Presses its buttons as a user would, and prints one line of JSON
// for each message that the debug node shows, and for each warning or error of a node.
const fs = require("node:fs");
const http = require("node:http");
const RED = require("node-red");

const [userDir, flow] = process.argv.slice(2);
const print = (kind, value) => console.log(JSON.stringify({ [kind]: value }));
// What a node says; Node-RED itself speaks without a type.
const log = (entry) => entry.type && print("logged", `${entry.type}: ${entry.msg}`);
const settings = {
  userDir,
  httpAdminRoot: false,
  httpNodeRoot: false,
  flowFile: "flow.json",
  credentialSecret: "test",
  logging: { test: { level: "warn", metrics: false, audit: false, handler: () => log } },
};
fs.copyFileSync(flow, `${userDir}/flow.json`);

// The next event of Node-RED of this kind at a node, from a node if that is given.
const next = (event, id, from) =>
  new Promise((resolve) => {
    RED.hooks.add(`${event}.test`, (happened) => {
      if (happened.destination.id !== id || (from && happened.source.id !== from)) return;
      RED.hooks.remove(`${event}.test`);
      resolve(happened.msg);
    });
  });
const press = (id) => RED.nodes.getNode(id).receive({});

async function run() {
  RED.init(http.createServer(), settings);
  const started = new Promise((resolve) => RED.events.once("flows:started", resolve));
  await RED.start();
  await started;

  // Nothing is asked before there is a contact.
  const read = next("postReceive", "created");
  press("stress-in");
  await read;
  for (const [button, last] of [["create-in", "keep"], ["move-in", "move"], ["back-in", "move"], ["stress-in", "largest"]]) {
    const shown = next("postDeliver", "shown", last);
    press(button);
    print(button, (await shown).payload);
  }
  await RED.stop();
  process.exit();
}
setTimeout(() => process.exit(1), 60_000).unref();
run();
