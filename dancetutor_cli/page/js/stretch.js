// Changes the speed of music without its pitch: overlapping pieces are placed where their waves match (WSOLA).
// Verhelst, Roelands: "An overlap-add technique based on waveform similarity (WSOLA)", ICASSP 1993.

const PIECE = 0.05; // seconds of a piece; half of it overlaps with the next
const SEARCH = 0.009; // seconds that a piece may be moved to fit
const COARSE = 4; // samples between places that are compared

export class Stretcher {
  /**
   * @param {Float32Array[]} channels the music @param {number} sampleRate
   * @param {number} rate speed, 1 is its own @param {number} from second to begin at; may be before the music
   */
  constructor(channels, sampleRate, rate, from) {
    this.channels = channels;
    this.rate = rate;
    this.length = channels[0].length;
    this.half = Math.round((PIECE * sampleRate) / 2);
    // Where the next piece comes from: by the middles of pieces, not by their beginnings.
    this.position = from * sampleRate + (rate - 1) * this.half;
    this.search = Math.round(SEARCH * sampleRate);
    this.natural = NaN; // place in the music where the last piece would continue
    this.window = Float32Array.from({ length: 2 * this.half }, (_, i) => Math.sin((Math.PI * (i + 0.5)) / (2 * this.half)) ** 2);
    this.tail = channels.map(() => new Float32Array(this.half));
    /** @type {Float32Array[]} what is made and not read yet */
    this.ready = channels.map(() => new Float32Array(0));
    this.begun = false;
  }

  /**
   * Return the next frames, one array for each channel.
   * @param {number} count @returns {Float32Array[]}
   */
  read(count) {
    if (this.rate === 1) return this.copy(count);
    while (this.ready[0].length < count) this.more();
    const out = this.ready.map((data) => data.subarray(0, count));
    this.ready = this.ready.map((data) => data.slice(count));
    return out;
  }

  /** Return frames of music at its own speed, unchanged. @param {number} count */
  copy(count) {
    const start = Math.round(this.position);
    this.position += count;
    return this.channels.map((data) => this.cut(data, start, count));
  }

  /** @param {Float32Array} data @param {number} start @param {number} count */
  cut(data, start, count) {
    const out = new Float32Array(count);
    const low = Math.max(0, -start);
    if (start + low < data.length) out.set(data.subarray(start + low, Math.max(start + count, start + low)), low);
    return out;
  }

  /** Add half a piece to the output. */
  more() {
    const wanted = Math.round(this.position);
    const start = this.begun ? this.alike(wanted) : wanted;
    const made = this.channels.map((data, c) => {
      const piece = this.cut(data, start, 2 * this.half);
      const out = new Float32Array(this.half);
      for (let i = 0; i < this.half; ++i) {
        // The first half piece has nothing to overlap with, so it is used as it is.
        out[i] = this.begun ? this.tail[c][i] + piece[i] * this.window[i] : piece[i];
        this.tail[c][i] = piece[this.half + i] * this.window[this.half + i];
      }
      return out;
    });
    this.ready = this.ready.map((data, c) => {
      const joined = new Float32Array(data.length + this.half);
      joined.set(data);
      joined.set(made[c], data.length);
      return joined;
    });
    this.begun = true;
    this.natural = start + this.half;
    this.position += this.half * this.rate;
  }

  /** Return the place near `wanted` whose wave is most like the continuation of the last piece. @param {number} wanted */
  alike(wanted) {
    const { natural, half, search } = this;
    if (natural < 0 || natural + half > this.length) return wanted;
    let best = wanted;
    let most = -Infinity;
    const try_ = (/** @type {number} */ start) => {
      if (start < 0 || start + half > this.length) return;
      let product = 0;
      let energy = 1e-9;
      for (const data of this.channels) {
        for (let i = 0; i < half; i += COARSE) {
          product += data[natural + i] * data[start + i];
          energy += data[start + i] * data[start + i];
        }
      }
      const score = product / Math.sqrt(energy);
      if (score > most) [best, most] = [start, score];
    };
    for (let start = wanted - search; start <= wanted + search; start += COARSE) try_(start);
    const rough = best;
    for (let start = rough - COARSE + 1; start < rough + COARSE; ++start) try_(start);
    return best;
  }
}
