// Feet from above on a 2-D canvas: what is shown where WebGL 2 is missing.

const LETTERS = ["L", "R", "L", "R"];

/**
 * @param {HTMLCanvasElement} canvas @param {import("./doc.js").PageDoc} doc
 * @param {{marks: import("./feet.js").Mark[], lights: Float32Array, mirror: boolean, next: {column: number, limb: number}[]}} shown
 */
export function drawFromAbove(canvas, doc, shown) {
  const c = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  const { width, height } = canvas;
  const { low, high } = doc.stage;
  const margin = 0.25;
  const scale = Math.min(width / (high[0] - low[0] + 2 * margin), height / (high[2] - low[2] + 2 * margin));
  const flip = shown.mirror ? 1 : -1; // her left is +x and lies left
  const x = (/** @type {number} */ v) => width / 2 + flip * (v - (low[0] + high[0]) / 2) * scale;
  const y = (/** @type {number} */ v) => height / 2 - (v - (low[2] + high[2]) / 2) * scale;
  c.fillStyle = doc.style.background;
  c.fillRect(0, 0, width, height);
  doc.pad.panels.forEach((/** @type {number[]} */ panel, /** @type {number} */ column) => {
    const side = 0.94 * doc.pad.width * scale;
    const px = x(-(panel[0] - doc.pad.centre[0]) * doc.pad.width);
    const py = y((panel[1] - doc.pad.centre[1]) * doc.pad.width);
    c.fillStyle = "#565f78";
    c.fillRect(px - side / 2, py - side / 2, side, side);
    const [r, g, b, lit] = shown.lights.subarray(4 * column, 4 * column + 4);
    c.fillStyle = `rgba(${r * 255}, ${g * 255}, ${b * 255}, ${lit})`;
    c.fillRect(px - side / 2, py - side / 2, side, side);
    const next = shown.next.find((step) => step.column === column);
    c.lineWidth = 3;
    c.strokeStyle = next ? (doc.style.limbs[next.limb] ?? "#fff") : "#b4bdd6";
    c.setLineDash(next ? [6, 4] : []);
    c.strokeRect(px - side / 2, py - side / 2, side, side);
    c.setLineDash([]);
    const way = doc.pad.directions[column];
    if (way === null) return;
    c.save();
    c.translate(px, py);
    c.rotate((-flip * way * Math.PI) / 180);
    c.beginPath();
    for (const [ax, ay] of [
      [0, -0.36],
      [0.32, 0],
      [0.11, 0],
      [0.11, 0.33],
      [-0.11, 0.33],
      [-0.11, 0],
      [-0.32, 0],
    ])
      c.lineTo(ax * side, ay * side);
    c.fillStyle = "rgba(180, 189, 214, 0.7)";
    c.fill();
    c.restore();
  });
  shown.marks.forEach((mark) => {
    if (mark.near < 0) return;
    const { limb } = mark;
    c.lineCap = "round";
    for (const [wide, colour] of /** @type {[number, string][]} */ ([[2.3, "#0a0b14"], [2, doc.style.limbs[limb]]])) {
      c.strokeStyle = colour;
      c.globalAlpha = 0.45 + 0.55 * mark.near;
      c.lineWidth = wide * doc.stage.sole * scale;
      c.beginPath();
      c.moveTo(x(mark.line[0]), y(mark.line[1]));
      c.lineTo(x(mark.line[2]) + 0.01, y(mark.line[3]));
      c.stroke();
    }
    c.globalAlpha = 1;
    c.fillStyle = "#0a0b14";
    c.font = `800 ${Math.round(1.5 * doc.stage.sole * scale)}px system-ui, sans-serif`;
    c.textAlign = "center";
    c.textBaseline = "middle";
    c.fillText(LETTERS[limb], (x(mark.line[0]) + x(mark.line[2])) / 2, (y(mark.line[1]) + y(mark.line[3])) / 2);
  });
}
