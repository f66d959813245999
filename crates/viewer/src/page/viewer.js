import { Cloud } from "/cloud.js";
import { COLOURS, curve, stacked, traces } from "/plots.js";

const by = (id) => document.getElementById(id);
const token = new URLSearchParams(location.search).get("token");
const headers = token ? { "X-OpenDR-Token": token } : {};
const HISTORY = 200;
let isPaused = false, isDrawn = true, number = 0, recorder = null, head = null, cloud = null, samples = null;
const latencies = [], memories = [], arrivals = [];

const wait = (time) => new Promise((done) => setTimeout(done, time));

async function get(path) {
  const response = await fetch(path, { headers });
  if (response.status === 204) return null;
  if (!response.ok) throw new Error(await response.text());
  return response;
}

/** Shows one of the canvases of the stage. */
function reveal(...names) {
  for (const name of ["picture", "cloud", "labels", "traces", "curves", "empty"]) by(name).hidden = !names.includes(name);
}

async function show(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const body = buffer.slice(4 + length);
  number = head.number;
  if (head.kind === "image") await showImage(body);
  else if (head.kind === "points") {
    reveal("cloud", "labels");
    cloud ??= new Cloud(by("cloud"), by("labels"));
    cloud.show(new Float32Array(body), isDrawn ? head.boxes : []);
  } else if (head.kind === "traces") {
    samples = new Float32Array(body);
    reveal("traces");
    drawTraces();
  } else {
    by("empty").textContent = "This input has no picture; the predictions are beside";
    reveal("empty");
  }
  describe();
}

async function showImage(body) {
  const picture = await createImageBitmap(new Blob([body], { type: "image/jpeg" }));
  const canvas = by("picture");
  reveal("picture");
  if (canvas.width !== picture.width || canvas.height !== picture.height) {
    canvas.width = picture.width;
    canvas.height = picture.height;
  }
  canvas.getContext("2d").drawImage(picture, 0, 0);
  picture.close();
}

function drawTraces() {
  const length = head.duration_s === undefined ? `${head.samples} instants` : `${head.duration_s.toFixed(2)} s`;
  traces(by("traces"), samples, head.traces, length);
}

/** Describes the item beside the stage. */
function describe() {
  by("input").textContent = head.points === undefined ? `${head.input} · ${head.index}` : `${head.input} · ${head.index} · ${head.points} points`;
  const outputs = head.outputs.flatMap(({ name, text }) => {
    const [title, list] = [document.createElement("h3"), document.createElement("pre")];
    [title.textContent, list.textContent] = [name, text.trim() || "none"];
    return [title, list];
  });
  by("outputs").replaceChildren(...outputs);
  const now = performance.now();
  arrivals.push(now);
  while (arrivals.length > 1 && now - arrivals[0] > 2000) arrivals.shift();
  const rate = arrivals.length > 1 ? ((arrivals.length - 1) * 1000) / (now - arrivals[0]) : 0;
  by("status").textContent = rate > 0 ? `item ${head.number} · ${rate.toFixed(1)} per second` : `item ${head.number}`;
  by("time").hidden = head.stages_ms.length === 0;
  latencies.push(head.stages_ms.map(([, time]) => time));
  if (latencies.length > HISTORY) latencies.shift();
  stacked(by("latency"), latencies);
  const stages = head.stages_ms.map(([name, time], at) => {
    const part = document.createElement("span");
    part.style.color = COLOURS[at % COLOURS.length];
    part.textContent = `${name} ${time.toFixed(1)} ms `;
    return part;
  });
  by("latency-text").replaceChildren(...stages);
  by("space").hidden = head.memory_mb === null;
  if (head.memory_mb !== null) {
    memories.push([head.number, head.memory_mb]);
    if (memories.length > HISTORY) memories.shift();
    curve(by("memory"), memories, COLOURS[2]);
    by("memory-text").textContent = `${head.memory_mb.toFixed(0)} MB resident`;
  }
}

async function follow() {
  for (;;) {
    if (isPaused) { await wait(100); continue; }
    try {
      const response = await get(`/api/next?after=${number}${isDrawn ? "" : "&plain=1"}`);
      if (response) await show(await response.arrayBuffer());
      else if (number === 0) by("status").textContent = "waiting";
      else by("status").textContent = `item ${number} · no new item`;
    } catch (error) {
      by("status").textContent = error instanceof TypeError ? "the program has ended" : error.message;
      await wait(1000);
    }
    await new Promise(requestAnimationFrame);
  }
}

async function followCurves() {
  for (;;) {
    try {
      const { unit, curves } = await (await get("/api/curves")).json();
      reveal("curves");
      const figures = curves.map(({ name: tag, points, is_scatter }, at) => {
        const figure = by(`curve ${tag}`) ?? document.createElement("figure");
        if (!figure.id) {
          figure.id = `curve ${tag}`;
          figure.append(document.createElement("figcaption"), document.createElement("canvas"));
          by("curves").append(figure);
        }
        const [name, value] = [document.createElement("span"), document.createElement("span")];
        [name.textContent, value.textContent] = [tag, points.length ? String(+points.at(-1)[1].toPrecision(5)) : ""];
        figure.firstChild.replaceChildren(name, value);
        curve(figure.lastChild, points, COLOURS[at % COLOURS.length], is_scatter);
        return is_scatter ? 0 : points.at(-1)?.[0] ?? 0;
      });
      by("status").textContent = curves.length ? `${unit} ${Math.max(...figures)}` : "no values yet";
    } catch (error) {
      by("status").textContent = error instanceof TypeError ? "the program has ended" : error.message;
    }
    await wait(2000);
  }
}

async function change(name, value) {
  const response = await fetch("/api/params", {
    method: "POST", headers: { ...headers, "Content-Type": "application/json" }, body: JSON.stringify({ name, value }),
  });
  by("failure").textContent = response.ok ? "" : await response.text();
}

/** Creates the control of a parameter. */
function control(param, isWritable) {
  const label = document.createElement("label"), name = document.createElement("span"), shown = document.createElement("output");
  name.textContent = param.unit ? `${param.name} (${param.unit})` : param.name;
  name.title = param.doc;
  const unpacked = (value) => (Array.isArray(value) ? value.join(", ") : String(value));
  shown.textContent = unpacked(param.value);
  label.append(name, shown);
  const isNumber = ["float", "int"].includes(param.kind) && param.low !== null && param.high !== null;
  let input = null;
  if (isNumber) {
    input = Object.assign(document.createElement("input"), { type: "range", min: param.low, max: param.high, step: param.kind === "int" ? 1 : "any", value: param.value });
    input.addEventListener("input", () => { shown.textContent = String(+Number(input.value).toPrecision(4)); change(param.name, Number(input.value)); });
  } else if (param.kind === "bool") {
    input = Object.assign(document.createElement("input"), { type: "checkbox", checked: param.value === true });
    input.addEventListener("change", () => { shown.textContent = String(input.checked); change(param.name, input.checked); });
  } else if (param.choices.length > 0) {
    input = document.createElement("select");
    input.append(...param.choices.map((choice) => new Option(choice, choice, false, choice === param.value)));
    input.addEventListener("change", () => { shown.textContent = input.value; change(param.name, input.value); });
  }
  if (input) {
    input.disabled = !isWritable;
    input.setAttribute("aria-label", param.name);
    label.append(input);
  }
  return label;
}

function press(id, isPressed) { by(id).setAttribute("aria-pressed", String(isPressed)); }

function download(blob, extension) {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: `opendr-${number}.${extension}` });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

const canvasOfStage = () => ["picture", "cloud", "traces"].map(by).find((canvas) => !canvas.hidden);

const actions = {
  pause() { isPaused = !isPaused; press("pause", isPaused); },
  overlay() { isDrawn = !isDrawn; press("overlay", isDrawn); number = 0; },
  snapshot() { canvasOfStage()?.toBlob((blob) => download(blob, "png")); },
  record() {
    if (recorder) { recorder.stop(); recorder = null; press("record", false); return; }
    const canvas = canvasOfStage();
    if (!canvas) return;
    const chunks = [];
    recorder = new MediaRecorder(canvas.captureStream(30));
    recorder.ondataavailable = ({ data }) => chunks.push(data);
    recorder.onstop = () => download(new Blob(chunks, { type: "video/webm" }), "webm");
    recorder.start();
    press("record", true);
  },
};
for (const [name, action] of Object.entries(actions)) by(name).addEventListener("click", action);
const keys = { " ": "pause", o: "overlay", s: "snapshot", r: "record" };
addEventListener("keydown", (event) => {
  const name = keys[event.key.toLowerCase()];
  if (!name || event.ctrlKey || event.metaKey || event.altKey || ["INPUT", "SELECT", "BUTTON"].includes(event.target.tagName)) return;
  event.preventDefault();
  actions[name]();
});
addEventListener("resize", () => { if (head?.kind === "points") cloud.draw(); else if (head?.kind === "traces") drawTraces(); });

const state = await (await get("/api/state").catch((error) => { by("status").textContent = error.message; throw error; })).json();
document.title = state.title ? `${state.title} · OpenDR` : "OpenDR";
by("title").textContent = state.title || "OpenDR";
by("failure").textContent = state.failure ?? "";
if (state.params.length > 0) {
  by("settings").hidden = false;
  by("params").replaceChildren(...state.params.map((param) => control(param, state.is_writable)));
}
if (state.has_curves) {
  for (const id of ["item", "predictions", "time", "space", "pause", "overlay", "snapshot", "record"]) by(id).hidden = true;
  document.body.classList.add("curves");
  followCurves();
} else follow();
