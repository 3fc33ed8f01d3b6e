// The parts of the page that need no browser.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import test from "node:test";

import { Axis, dataRange, nearestIndex } from "../../src/page/axis.js";
import { columnsOf, csvText } from "../../src/page/chart_menu.js";
import { rememberedTurns } from "../../src/page/contact_plots.js";
import { amountOf } from "../../src/page/crack_criteria.js";
import { latestOnly } from "../../src/page/dom.js";
import { MEANINGS } from "../../src/page/meanings.js";
import { isEccentric, meanPressure, peaksOf, zonesOf } from "../../src/page/line_contact.js";
import { pythonCode } from "../../src/page/python_code.js";
import { followed } from "../../src/page/relaxation.js";
import { gridPoints } from "../../src/page/section_plot.js";
import { addressOf, contactAddress } from "../../src/page/tabs.js";
import * as units from "../../src/page/units.js";

const NOT_A_NUMBER = "This must be a number, without its unit and without separators of thousands.";

test("a typed number is read in its unit, by way of its digits", () => {
  for (const [text, power, value] of [
    ["10", -3, 0.01],
    ["0,1", -6, 1e-7],
    ["−2.5e3", -9, -2.5e-6],
    [".5", 0, 0.5],
    ["1000,000e-2", 0, 10],
    ["0,300", 0, 0.3],
    ["", 0, undefined],
  ])
    assert.equal(units.parseNumber(text, power), value, text);
});

test("what is no number, or may be two, is said in words", () => {
  for (const [text, said] of [
    ["1,000", "Write 1.000 or 1000: 1,000 may be either."],
    ["−12,345e-3", "Write -12.345e-3 or -12345e-3: -12,345e-3 may be either."],
    ["1,000,000", NOT_A_NUMBER],
    ["1.000,5", NOT_A_NUMBER],
    ["10 mm", NOT_A_NUMBER],
    ["much", NOT_A_NUMBER],
  ]) {
    assert.equal(units.numberMistake(text), said);
    assert.equal(typeof units.parseNumber(text), "string", "it is not read as a number");
  }
  for (const text of ["1.000", "12,5", "0,300", "1000,000e-2", ""]) assert.equal(units.numberMistake(text), undefined);
});

test("the force over the time is followed at the even pace of each move, and jumps where a move takes none", () => {
  const at = (sequence, time) => ({ sequence, state: { time } });
  const all = [at(0, undefined), at(1, 2), at(2, 2), at(3, 6)];
  const path = [
    [0, 0, 0],
    [1, 5, 1, 0.5],
    [2, 9, 1, 1],
    [3, 4, 2, 0.5],
    [3, 1, 2],
    [3, 0, 3, 0.25],
    [0, 0, 9],
  ];
  assert.deepEqual(followed(all, path), [
    [0, 0, 0],
    [1, 5, 1],
    [2, 9, 1],
    [2, 4, 2],
    [2, 1, 2],
    [3, 0, 3],
  ]);
});

test("numbers have a true minus, raised powers and the prefix that fits", () => {
  assert.equal(units.formatNumber(1.06149e-5), "1.061 × 10⁻⁵");
  assert.equal(units.formatNumber(-0.25), "−0.25");
  assert.equal(units.formatNumber(null), "∞");
  assert.equal(units.formatQuantity(1.60244e-7, "m"), "160.2 nm");
  assert.equal(units.formatQuantity(0.9999999e-6, "m"), "1 µm");
  assert.equal(units.formatQuantity(0, "Pa"), "0 Pa");
  assert.equal(units.formatInterval([-2e-10, 3.1e-9], "m"), "−0.2 to 3.1 nm");
  assert.equal(units.formatInterval([null, 0.42], ""), "open to 0.42");
  // A prefix would be squared with its unit.
  assert.equal(amountOf("ruiz_tension", 2.5e9, 3), "2.5 × 10⁹ N²/m³");
});

test("a value is shown in a unit as one would type it", () => {
  assert.equal(units.inPower(3e-7, -6), "0.3");
  assert.equal(units.inPower(4.9e-6, -9), "4900");
  for (const power of [-9, -6, -3, 0]) assert.equal(units.parseNumber(units.inPower(1.25e-4, power), power), 1.25e-4);
  assert.deepEqual(units.prefixed("N", "k", "", "µ"), [
    ["kN", 3],
    ["N", 0],
    ["µN", -6],
  ]);
});

test("an axis leads from values to pixels and back, with round numbers", () => {
  const axis = new Axis({ label: "Displacement U", unit: "m" });
  const texts = () =>
    axis
      .ticks(80)
      .map(([, text]) => text)
      .join();
  axis.fit([0, 8e-9], 0, 400);
  assert.equal(texts(), "0,2,4,6,8");
  axis.fit([-2e-7, 3e-7], 60, 460);
  assert.equal(axis.title(), "Displacement U (nm)");
  assert.equal(texts(), "−200,−100,0,100,200,300");
  for (const value of [-2e-7, 0, 1.7e-7]) assert.ok(Math.abs(axis.back(axis.at(value)) - value) < 1e-20);
  const log = new Axis({ label: "Amplitude", unit: "m", log: true });
  log.fit([1e-9, 1e-4], 400, 20);
  assert.ok(Math.abs(log.at(1e-4) - 20) < 1e-9 && Math.abs(log.back(400) / 1e-9 - 1) < 1e-12);
  assert.ok(log.ticks(45).every(([value]) => Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-9));
  // What is not on a logarithmic axis does not count.
  const [low, high] = dataRange([0, -1, 10, 1000, NaN], true);
  assert.ok(low > 1 && low < 10 && high > 1000);
  assert.equal(nearestIndex([0, 1, 4], 2.4), 1);
});

/** States of a path at one indentation, whose slip histories have so many pieces. */
const states = (list) =>
  list.map(([displacement, memory_depth, regime = "partial_slip"], sequence) => ({
    sequence,
    state: { displacement, memory_depth, regime, indentation: 1e-6 },
  }));
const turnsOf = (list) => {
  const [first, ...history] = states([[0, 0, "stick"], ...list]);
  return rememberedTurns(first, history).map(({ displacement }) => displacement);
};

test("the turning points are those that the slip history of the service still has", () => {
  const path = [[0.9, 2], [-0.7, 3], [0.5, 4], [-0.3, 5], [0.4, 6]]; // prettier-ignore
  assert.deepEqual(turnsOf(path), [0.9, -0.7, 0.5, -0.3]);
  assert.deepEqual(turnsOf([...path, [-0.4, 5]]), [0.9, -0.7, 0.5]);
  assert.deepEqual(turnsOf([...path, [-0.4, 5], [-0.8, 3]]), [0.9]);
  // The mirror image of the first turn erases it, and gross slip everything.
  assert.deepEqual(turnsOf([[0.5, 2], [-0.6, 2]]), []); // prettier-ignore
  assert.deepEqual(turnsOf([[0.5, 2], [-1.5, 1, "gross_slip"], [0.2, 2]]), [-1.5]); // prettier-ignore
  const [first, ...history] = states([[0, 0], [0.5, 2], [0.1, 3]]); // prettier-ignore
  history[1].state.indentation = 2e-6;
  assert.deepEqual(rememberedTurns(first, history), [], "not where the load has changed");
});

test("a table is saved by its columns, and a plot without one by its series", () => {
  const chart = { data: {}, x: { label: "Radius r", unit: "m" }, y: { label: "Stress", unit: "Pa" } };
  chart.data = { series: [{ name: 'a "b", c', points: [[1, null]] }] };
  assert.equal(csvText(chart), 'series,Radius r m,Stress Pa\n"a ""b"", c",1,\n');
  chart.data.table = () => columnsOf([{ u: 1, f: 2 }, { u: 3 }], { displacement_m: "u", force_n: "f" });
  assert.equal(csvText(chart), "displacement_m,force_n\n1,2\n3,\n");
});

test("places of a grid are drawn row by row", () => {
  const reply = { x: [0, 0, 1, 1], z: [0, 5, 0, 5] };
  assert.deepEqual(gridPoints(reply, [1, 2, 3, 4], 2), [[0, 0, 1], [1, 0, 3], [0, 5, 2], [1, 5, 4]]); // prettier-ignore
});

test("a line contact has two edges, a stick zone off the middle, and extrema on both sides", () => {
  const state = { contact_radius: 4, stick_radius: 2, normal_force: 24 };
  const ends = (zones) => zones.map(({ from, to, kind }) => [from, to, kind]);
  assert.deepEqual(ends(zonesOf(state, false)), [[0, 2, "stick"], [2, 4, "slip"]]); // prettier-ignore
  const shifted = { ...state, stick_centre: 1 };
  const zones = [[-4, -1, "slip"], [-1, 3, "stick"], [3, 4, "slip"]]; // prettier-ignore
  assert.deepEqual(ends(zonesOf(shifted, true)), zones);
  // In gross slip a bulk stress still has a middle, but of nothing.
  assert.deepEqual(ends(zonesOf({ ...shifted, stick_radius: 0 }, true)), [[-4, 4, "slip"]]);
  assert.deepEqual(ends(zonesOf({ ...state, stick_radius: 4, stick_centre: 0 }, true)), [[-4, 4, "stick"]]);

  const material = { bodies: ["rigid", { youngs_modulus: 1, poisson_ratio: 0 }] };
  const definition = { profile: { type: "cylinder", radius: 1, length: 3 }, material };
  const peaks = [{ x: 1, shear: -5 }, { x: 2, shear: null }]; // prettier-ignore
  assert.deepEqual(peaksOf({ peaks }, definition), [[1, -5], [-1, -5]]); // prettier-ignore
  const bulk = { body: "second", stress_per_force: 1 };
  assert.deepEqual(peaksOf({ peaks }, { ...definition, bulk }), [[1, -5]]);
  for (const still of [{ ...bulk, body: "first" }, { ...bulk, stress_per_force: 0 }, undefined])
    assert.equal(isEccentric({ bulk: still, material }), false, "a rigid body, and no stress, move nothing");
  assert.equal(meanPressure(definition, state), 1);
  const round = { profile: { type: "sphere", radius: 1 } };
  assert.equal(meanPressure(round, state), 24 / (16 * Math.PI));
  assert.deepEqual(peaksOf({ peaks: [{ radius: 1, shear: 2 }] }, round), [[1, 2]]);
});

test("an address names contact, tab and view", () => {
  assert.deepEqual(contactAddress("#/contacts/0-a/crack?with=b"), { id: "0-a", tab: "crack", query: "?with=b" });
  assert.equal(contactAddress("#/contacts/0-a/unknown").tab, "live");
  assert.equal(contactAddress("#/new"), undefined);
  for (const tab of ["live", "residual"]) assert.equal(contactAddress(addressOf("0-a", tab)).tab, tab);
});

test("of the calls during a run only the last is made, and only its error counts", async () => {
  const made = [];
  let go;
  const work = latestOnly(async (one) => {
    made.push(one);
    if (one === 1) await new Promise((resolve) => (go = resolve));
    if (one < 3) throw new Error("the last succeeds");
  });
  const first = work(1);
  await work(2);
  await work(3);
  go();
  await first;
  assert.deepEqual(made, [1, 3]);
  await assert.rejects(work(2));
});

test("requests are written in Python as the package takes them", () => {
  const contact = { profile: { type: "sphere", radius: 0.01 }, friction: 0.3, preload: { normal_force: 20 } };
  const calls = [
    { method: "GET", path: "/contacts/7" },
    { method: "GET", path: "/contacts/7/stress?points=300&residual=true&fields=pressure,shear" },
    { method: "POST", path: "/contacts/7/move", body: { displacement: 1e-7 } },
    { method: "POST", path: "/contacts/7/relax", body: { reversals: 20, dry_run: true } },
    { method: "GET", path: "/contacts/7/history?limit=1000" },
    {
      method: "POST",
      path: "/simulate",
      body: { contact, path: { falling_amplitude: { reversals: 20 } }, residual: true, solver: undefined },
    },
    { method: "POST", path: "/fit", body: { contact, loops: [{ force: [1, null] }] } },
  ];
  const definition =
    '{"profile": {"type": "sphere", "radius": 0.01}, "friction": 0.3, "preload": {"normal_force": 20}}';
  assert.equal(
    pythonCode(calls, "http://localhost:8080", false),
    `import stickslip as ss

api = ss.connect("http://localhost:8080")
contact = api.open("7")
print(contact.state)
print(contact.stress(points=300, residual=True, fields=["pressure", "shear"]))
print(contact.move(displacement=1e-7))
print(contact.relax(reversals=20, dry_run=True))
print(contact.history())
print(api.simulate(${definition}, falling_amplitude={"reversals": 20}, residual=True))
print(api.fit(${definition}, loops=[{"force": [1, None]}]))`,
  );
  assert.match(pythonCode([], "https://lab", true), /^import os\n\nimport .*key=os.environ\["STICKSLIP_KEY"\]\)$/s);
  assert.match(pythonCode([{ method: "POST", path: "/contacts", body: contact }], "", false), /from_definition/);
});

test("every figure of the page has a meaning, and every meaning a figure", () => {
  const folder = new URL("../../src/page/", import.meta.url);
  const scripts = readdirSync(folder).filter((name) => name.endsWith(".js") && name !== "meanings.js");
  const shown = scripts.map((name) => readFileSync(new URL(name, folder), "utf8")).join("");
  for (const name of Object.keys(MEANINGS)) assert.ok(shown.includes(`"${name}"`), name);
  // A sentence in place of a number says it itself.
  const sentences = ["Of", "Wear"];
  const figures = [...shown.matchAll(/figure\(\s*(?:[^"()]*(?:\([^()]*\))?[^"()]*\? )?"([^"]+)"(?: : "([^"]+)")?/g)];
  const names = figures.flatMap(([, one, other]) => [one, other]).filter((name) => name && !sentences.includes(name));
  assert.ok(names.length > 40, `${names.length} figures`);
  for (const name of names) assert.ok(name in MEANINGS, name);
});
