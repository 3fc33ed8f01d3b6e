// How a contact damps: stiffness and loss factor over the amplitude, and the oscillations of a mass that hangs on it.
import { Chart } from "./chart.js";
import { columnsOf } from "./chart_menu.js";
import { el, figure } from "./dom.js";
import { Fields, NumberField } from "./form_fields.js";
import { FORCE } from "./form_options.js";
import { virginContact } from "./protocol_run.js";
import { study } from "./study.js";
import { formatNumber, formatQuantity } from "./units.js";

/** Amplitudes of the backbone, from the smallest to the largest over that of gross slip. */
const [COUNT, SMALLEST, LARGEST] = [60, 1e-3, 2];
/** Frequencies, if a range is asked for, and the largest number of them. */
const [FREQUENCIES, MOST_FREQUENCIES] = [200, 1000];
const MASSES = [
  ["kg", 0],
  ["g", -3],
  ["t", 3],
];

/** Amplitudes about gross slip, evenly spaced in their logarithm. */
const amplitudes = (slip) =>
  Array.from({ length: COUNT }, (_, index) => slip * SMALLEST * (LARGEST / SMALLEST) ** (index / (COUNT - 1)));

/** The request of the form; fields that were left out are not sent. */
function requestOf(model, { mass, drive, from, to, count, machine, tolerance }) {
  const slip = Math.max(model.slip(model.state), 0) || model.figures.gross_slip_displacement || 1e-7;
  const [low, high, points] = [from.value, to.value, count.value ?? FREQUENCIES];
  const spaced = (index) => low * (high / low) ** (index / Math.max(points - 1, 1));
  const hasRange =
    [low, high, points].every((value) => typeof value === "number") && points >= 1 && points <= MOST_FREQUENCIES;
  return {
    contact: virginContact(model),
    drive: { displacement: amplitudes(slip) },
    harmonics: 1,
    frequency_response: {
      mass: mass.value,
      drive_force: drive.value,
      frequencies: hasRange ? Array.from({ length: points }, (_, index) => spaced(index)) : undefined,
    },
    machine: machine.value === undefined ? undefined : { stiffness: machine.value },
    tolerance: tolerance.value,
  };
}

/** The resonance of a reply in rows. */
function figureRows({ natural_frequency: natural, points }, drive) {
  const most = points.reduce((best, point) => (point.amplitude > best.amplitude ? point : best));
  const errors = points.map((point) => point.amplitude_error).filter((error) => error !== null);
  const worst = errors.length ? Math.max(...errors) : null;
  return [
    figure("Frequency of small oscillations", formatQuantity(natural, "Hz")),
    figure("Largest amplitude", `${formatQuantity(most.amplitude, "m")} at ${formatQuantity(most.frequency, "Hz")}`),
    figure("Force over that amplitude", formatQuantity(drive / most.amplitude, "N/m", 3)),
    figure("Phase there", `${formatNumber(most.phase, 3)}°`),
    figure("Largest error of an amplitude", worst === null ? "not known" : formatQuantity(worst, "m", 2)),
  ];
}

/** The two plots. */
function plots() {
  const stiffness = new Chart({
    name: "backbone",
    title: "Stiffness and loss factor over the amplitude",
    height: 240,
    x: { label: "Amplitude U_0", unit: "m", log: true },
    y: { label: "Loss factor; stiffness of 1 when small" },
    note:
      "Stiffness is force over displacement amplitude, relative to small motions; the loss factor is the " +
      "friction work of a cycle over 2π times the largest stored energy.",
  });
  const response = new Chart({
    name: "response",
    title: "Frequency response",
    mode: "nearest",
    height: 320,
    x: { label: "Frequency", unit: "Hz", log: true },
    y: { label: "Displacement", unit: "m", log: true },
    note:
      "The amplitude is that of the first harmonic, the peak half the range of the displacement. The backbone is " +
      "the resonance of the mass on the stiffness at each amplitude.",
  });
  response.more = ([, , phase], { name }) => [
    name,
    ...(phase === undefined ? [] : [`phase ${formatNumber(phase, 3)}°`]),
  ];
  return { stiffness, response };
}

/** Draws a reply. */
function draw({ stiffness, response }, { cycles, frequency_response: resonance }, mass) {
  stiffness.draw({
    series: [
      {
        name: "stiffness",
        kind: "stored",
        points: cycles.map((cycle) => [cycle.displacement_amplitude, cycle.secant_stiffness / cycle.tangent_stiffness]),
      },
      {
        name: "loss factor",
        kind: "work",
        points: cycles.map((cycle) => [cycle.displacement_amplitude, cycle.loss_factor]),
      },
    ],
    least: { y: [0] },
    table: () =>
      columnsOf(cycles, {
        displacement_amplitude_m: "displacement_amplitude",
        force_amplitude_n: "force_amplitude",
        secant_stiffness_n_per_m: "secant_stiffness",
        loss_factor: "loss_factor",
        friction_work_j: "dissipated_energy",
      }),
  });
  // The first harmonic of the force in phase with the displacement is what a resonance feels.
  const backbone = cycles
    .map((cycle) => [cycle.harmonics[0].in_phase / cycle.displacement_amplitude, cycle.displacement_amplitude])
    .filter(([k]) => k > 0)
    .map(([k, amplitude]) => [Math.sqrt(k / mass) / (2 * Math.PI), amplitude]);
  const { points } = resonance;
  const [first, last] = [points[0].frequency, points.at(-1).frequency];
  const [low, high] = [Math.min(...points.map((one) => one.amplitude)), Math.max(...points.map((one) => one.peak))];
  response.draw({
    series: [
      { name: "amplitude", kind: "now", points: points.map((one) => [one.frequency, one.amplitude, one.phase]) },
      { name: "peak", kind: "bound", points: points.map((one) => [one.frequency, one.peak, one.phase]) },
      {
        name: "backbone",
        kind: "past",
        points: backbone.filter(([f, u]) => f >= first && f <= last && u >= low && u <= 1.5 * high),
      },
    ],
    table: () =>
      columnsOf(points, {
        frequency_hz: "frequency",
        amplitude_m: "amplitude",
        amplitude_error_m: "amplitude_error",
        peak_m: "peak",
        phase_deg: "phase",
        third_harmonic: "third_harmonic",
      }),
  });
}

/** The card, its plots and the request behind it. */
export function responseCard(model) {
  const form = new Fields();
  const field = (pointer, about) => new NumberField(form, () => pointer, about);
  const limit = 0.5 * model.friction * (model.state.normal_force || model.figures.normal_force) || 1;
  const response = "/frequency_response";
  const fields = {
    mass: field(`${response}/mass`, { label: "Mass on the contact", units: MASSES, unit: "kg", value: "1" }),
    drive: field(`${response}/drive_force`, {
      label: "Amplitude of the force that drives it",
      units: FORCE,
      unit: "N",
      value: String(Number(limit.toPrecision(3))),
    }),
    from: field(`${response}/frequencies/0`, { label: "From, Hz", optional: true }),
    to: field(`${response}/frequencies`, { label: "To, Hz", optional: true }),
    count: field(`${response}/frequencies/count`, { label: "Number of frequencies", optional: true }),
    machine: field("/machine/stiffness", { label: "Stiffness of a machine in series, N/m", optional: true }),
    tolerance: field("/tolerance", { label: "Accepted relative error", optional: true }),
  };
  const { from, to, count, machine, tolerance } = fields;
  const charts = plots();
  return study({
    name: "response",
    title: "Frequency response",
    text:
      "A force drives a mass that only the contact holds, at the present load: how far it swings, and how far behind " +
      "the force.",
    form,
    parts: [
      fields.mass.element,
      fields.drive.element,
      el(
        "details",
        {},
        el("summary", {}, "Frequencies, machine and accuracy"),
        ...[from, to, count, machine, tolerance].map((one) => one.element),
      ),
    ],
    charts: [charts.response, charts.stiffness],
    signal: model.signal,
    path: "/cycle",
    request: () => requestOf(model, fields),
    rows: (reply, asked) => figureRows(reply.frequency_response, asked.frequency_response.drive_force),
    show: (reply, asked) => draw(charts, reply, asked.frequency_response.mass),
  });
}
