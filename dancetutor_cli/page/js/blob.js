// Reads the page's data back: JSON, and the arrays it names, out of one compressed block (see page/document.py).

/** @typedef {Uint8Array | Int8Array | Uint16Array | Int16Array | Uint32Array | Int32Array | Float32Array | Float64Array} Numbers */

const KINDS = {
  u1: Uint8Array, i1: Int8Array, u2: Uint16Array, i2: Int16Array, u4: Uint32Array, i4: Int32Array,
  f4: Float32Array, f8: Float64Array,
};

/**
 * Bytes of base64 text.
 * @param {string} text
 * @returns {Uint8Array}
 */
export function fromBase64(text) {
  const own = /** @type {{fromBase64?: (text: string) => Uint8Array}} */ (Uint8Array).fromBase64; // of new browsers, many times quicker
  if (own) return own.call(Uint8Array, text);
  const raw = atob(text);
  const out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) out[i] = raw.charCodeAt(i);
  return out;
}

/**
 * Undo zlib's compression.
 * @param {Uint8Array} data
 * @returns {Promise<Uint8Array>}
 */
async function inflate(data) {
  const stream = new Blob([/** @type {BlobPart} */ (data)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The arrays of the page, by name. */
export class Arrays {
  /**
   * @param {Uint8Array} bytes
   * @param {Record<string, import("./doc.js").ArrayEntry>} index
   */
  constructor(bytes, index) {
    this.bytes = bytes;
    this.index = index;
  }

  /** @param {string} name */
  has(name) {
    return name in this.index;
  }

  /**
   * An array, put together from its planes of bytes, its differences added up.
   * @param {string} name
   * @returns {Numbers}
   */
  get(name) {
    const entry = this.index[name];
    if (!entry) throw new Error(`no array ${name}`);
    const [kind, count, row, differences, offset] = entry;
    const out = new KINDS[kind](count);
    const width = out.BYTES_PER_ELEMENT;
    const to = new Uint8Array(out.buffer);
    for (let plane = 0; plane < width; ++plane) {
      const from = this.bytes.subarray(offset + plane * count, offset + (plane + 1) * count);
      if (width === 1) to.set(from);
      else for (let i = 0, at = plane; i < count; ++i, at += width) to[at] = from[i];
    }
    if (differences) {
      const raw = new (width === 1 ? Uint8Array : width === 2 ? Uint16Array : Uint32Array)(out.buffer);
      for (let i = 0; i < count; ++i) raw[i] = (raw[i] >>> 1) ^ -(raw[i] & 1); // the sign is the lowest bit
    }
    for (let round = 0; round < differences; ++round) {
      for (let start = 0; start < count; start += row) {
        for (let i = start + 1, sum = out[start]; i < start + row; ++i) sum = out[i] += sum;
      }
    }
    return out;
  }
}

/**
 * The page's JSON and its arrays, from its base64 text.
 * @param {string} text
 * @returns {Promise<{doc: import("./doc.js").PageDoc, arrays: Arrays}>}
 */
export async function unpack(text) {
  const bytes = await inflate(fromBase64(text));
  const length = new DataView(bytes.buffer).getUint32(0, true);
  const doc = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
  return { doc, arrays: new Arrays(bytes.subarray(4 + length), doc.arrays) };
}
