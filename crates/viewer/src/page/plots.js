// Curves over time on a canvas.

export const COLOURS = ["#4cc2ff", "#ffb454", "#7fd962", "#f07178", "#d2a6ff", "#95e6cb", "#ffd580", "#aad94c"];

/** Fits a canvas to its size on the page and returns its context with that size in CSS pixels. */
export function prepared(canvas) {
  const { width, height } = canvas.getBoundingClientRect();
  const ratio = window.devicePixelRatio || 1;
  const size = [Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio))];
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return { context, width, height };
}

/** Draws values as areas upon each other: `moments` has an array of numbers for each moment; a single one fills the width. */
export function stacked(canvas, moments) {
  const rows = moments.length === 1 ? [moments[0], moments[0]] : moments;
  const { context, width, height } = prepared(canvas);
  const totals = rows.map((row) => row.reduce((sum, value) => sum + value, 0));
  const most = Math.max(...totals, 1e-9);
  const count = Math.max(rows.length - 1, 1);
  let below = rows.map(() => 0);
  for (let series = 0; series < (rows.at(-1)?.length ?? 0); series++) {
    const above = rows.map((row, at) => below[at] + (row[series] ?? 0));
    const point = (at, value) => [(at / count) * width, height - (value / most) * (height - 2)];
    context.beginPath();
    above.forEach((value, at) => context.lineTo(...point(at, value)));
    for (let at = rows.length - 1; at >= 0; at--) context.lineTo(...point(at, below[at]));
    context.fillStyle = COLOURS[series % COLOURS.length];
    context.fill();
    below = above;
  }
}

const short = (value) => (Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3) ? value.toExponential(2) : String(+value.toPrecision(4)));

/** Draws [step, value] pairs with the axes' ends, as a line or as points. */
export function curve(canvas, points, colour = COLOURS[0], isScatter = false) {
  const { context, width, height } = prepared(canvas);
  const finite = points.filter(([step, value]) => Number.isFinite(step) && Number.isFinite(value));
  if (finite.length === 0) return;
  const steps = finite.map(([step]) => step).sort((a, b) => a - b), values = finite.map(([, value]) => value);
  const [first, last] = [steps[0], steps.at(-1)];
  const [low, high] = [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
  const left = 4, bottom = 16, top = 4;
  const x = (step) => left + (last > first ? (step - first) / (last - first) : 0.5) * (width - 2 * left);
  const y = (value) => height - bottom - (high > low ? (value - low) / (high - low) : 0.5) * (height - bottom - top);
  context.strokeStyle = "#2b3644";
  context.strokeRect(left, top, width - 2 * left, height - bottom - top);
  context.fillStyle = "#93a1b1";
  context.font = "11px system-ui, sans-serif";
  context.fillText(short(high), left + 3, top + 11);
  context.fillText(short(low), left + 3, height - bottom - 4);
  context.fillText(short(first), left, height - 3);
  const end = short(last);
  context.fillText(end, width - left - context.measureText(end).width, height - 3);
  context.strokeStyle = context.fillStyle = colour;
  context.lineWidth = 1.5;
  if (!isScatter) {
    context.beginPath();
    finite.forEach(([step, value]) => context.lineTo(x(step), y(value)));
    context.stroke();
  }
  if (isScatter || finite.length < 3) finite.forEach(([step, value]) => context.fillRect(x(step) - 2, y(value) - 2, 4, 4));
}

/** Draws traces: `bounds` has the minimum and the maximum of each column of each trace. */
export function traces(canvas, bounds, count, text) {
  const { context, width, height } = prepared(canvas);
  const columns = bounds.length / 2 / Math.max(count, 1);
  for (let trace = 0; trace < count; trace++) {
    const part = bounds.subarray(trace * columns * 2, (trace + 1) * columns * 2);
    const low = part.reduce((a, b) => Math.min(a, b), Infinity), high = part.reduce((a, b) => Math.max(a, b), -Infinity);
    const top = 24 + (trace * (height - 40)) / count, tall = (height - 40) / count - 8;
    const y = (value) => top + tall * (1 - (high > low ? (value - low) / (high - low) : 0.5));
    context.strokeStyle = COLOURS[trace % COLOURS.length];
    context.beginPath();
    for (let column = 0; column < columns; column++) {
      const x = 8 + (column / Math.max(columns - 1, 1)) * (width - 16);
      context.lineTo(x, y(part[2 * column]));
      context.lineTo(x, y(part[2 * column + 1]));
    }
    context.stroke();
  }
  context.fillStyle = "#93a1b1";
  context.font = "12px system-ui, sans-serif";
  context.fillText(text, 8, 16);
}
