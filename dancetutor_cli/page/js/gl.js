// Programs, meshes and textures of WebGL 2: what the viewer draws with.

/** @typedef {{program: WebGLProgram, at: Record<string, WebGLUniformLocation | null>}} Program */

/** @param {WebGL2RenderingContext} gl @param {{first: number, count: number}} part */
export function drawPart(gl, part) {
  gl.drawElements(gl.TRIANGLES, 3 * part.count, gl.UNSIGNED_INT, 12 * part.first);
}

/**
 * @param {WebGL2RenderingContext} gl @param {number} unit @param {WebGLTexture} texture
 * @param {WebGLUniformLocation | null} at
 */
export function bind(gl, unit, texture, at) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.uniform1i(at, unit);
}

/**
 * Programs out of vertex and fragment shaders; all are given to the driver before the first is asked for.
 * @param {WebGL2RenderingContext} gl @param {[string, string][]} sources @returns {Program[]}
 */
export function build(gl, sources) {
  const made = sources.map((texts) => {
    const program = gl.createProgram();
    const shaders = texts.map((text, k) => {
      const shader = /** @type {WebGLShader} */ (gl.createShader(k ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER));
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      return shader;
    });
    gl.linkProgram(program);
    return { program, shaders };
  });
  return made.map(({ program, shaders }) => {
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      const logs = shaders.map((shader) => gl.getShaderInfoLog(shader));
      throw new Error(`shaders: ${[gl.getProgramInfoLog(program), ...logs].filter(Boolean).join("; ")}`);
    }
    /** @type {Record<string, WebGLUniformLocation | null>} */
    const at = {};
    const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
    for (let i = 0; i < count; ++i) {
      const name = /** @type {WebGLActiveInfo} */ (gl.getActiveUniform(program, i)).name.replace("[0]", "");
      at[name] = gl.getUniformLocation(program, name);
    }
    return { program, at };
  });
}

/** @typedef {ReturnType<typeof meshData>} MeshData */

/**
 * The dancer's mesh as the graphics card reads it.
 * @param {import("./doc.js").Body} body @param {import("./blob.js").Arrays} arrays
 */
export function meshData(body, arrays) {
  const n = body.vertices;
  const place = arrays.get("mesh.position");
  const uv = arrays.get("mesh.uv");
  const floats = new Float32Array(5 * n);
  for (const [k, from, size, values, at] of /** @type {[number, number[], number[], import("./blob.js").Numbers, number][]} */ ([
    [0, body.low, body.size, place, 0], [1, body.low, body.size, place, 1], [2, body.low, body.size, place, 2],
    [0, body.uv[0], body.uv[1], uv, 3], [1, body.uv[0], body.uv[1], uv, 4],
  ])) {
    const low = from[k];
    const scale = size[k] / 65535;
    for (let v = 0, i = k * n, to = at; v < n; ++v, ++i, to += 5) floats[to] = low + values[i] * scale;
  }
  const columns = arrays.get("mesh.triangles");
  const count = columns.length / 3;
  const triangles = new Uint32Array(columns.length);
  for (let k = 0, i = 0; k < 3; ++k) for (let t = 0, to = k; t < count; ++t, ++i, to += 3) triangles[to] = columns[i];
  return {
    floats, triangles,
    normals: interleaved(arrays.get("mesh.normal"), n, 3, Int8Array),
    hull: interleaved(arrays.get("mesh.hull"), n, 3, Int8Array),
    joints: interleaved(arrays.get("mesh.joints"), n, 4, Uint8Array),
    weights: interleaved(arrays.get("mesh.weights"), n, 4, Uint8Array),
    above: Float32Array.from(/** @type {ArrayLike<number>} */ (arrays.get("mesh.above")), (part) => (part * body.above) / 255),
  };
}

/** @param {WebGL2RenderingContext} gl @param {MeshData} data */
export function makeMesh(gl, data) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  buffer(gl, gl.ARRAY_BUFFER, data.floats);
  attribute(gl, 0, 3, gl.FLOAT, 20, 0, false);
  attribute(gl, 3, 2, gl.FLOAT, 20, 12, false);
  buffer(gl, gl.ARRAY_BUFFER, data.normals);
  attribute(gl, 1, 3, gl.BYTE, 4, 0, true);
  buffer(gl, gl.ARRAY_BUFFER, data.hull);
  attribute(gl, 2, 3, gl.BYTE, 4, 0, true);
  buffer(gl, gl.ARRAY_BUFFER, data.joints);
  attribute(gl, 4, 4, gl.UNSIGNED_BYTE, 4, 0, false);
  buffer(gl, gl.ARRAY_BUFFER, data.weights);
  attribute(gl, 5, 4, gl.UNSIGNED_BYTE, 4, 0, true);
  buffer(gl, gl.ARRAY_BUFFER, data.above);
  attribute(gl, 6, 1, gl.FLOAT, 4, 0, false);
  buffer(gl, gl.ELEMENT_ARRAY_BUFFER, data.triangles);
  gl.bindVertexArray(null);
  return array;
}

/**
 * Columns of values as four bytes a vertex.
 * @param {import("./blob.js").Numbers} columns @param {number} n @param {number} width
 * @param {Int8ArrayConstructor | Uint8ArrayConstructor} kind
 */
function interleaved(columns, n, width, kind) {
  const out = new kind(4 * n);
  for (let k = 0, i = 0; k < width; ++k) for (let v = 0, to = k; v < n; ++v, ++i, to += 4) out[to] = columns[i];
  return out;
}

/** @param {WebGL2RenderingContext} gl @param {import("./doc.js").Stage} stage */
export function makeRoom(gl, stage) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  const floats = [];
  const triangles = [];
  for (let q = 0; q < stage.kinds.length; ++q) {
    for (let c = 0; c < 4; ++c) floats.push(...stage.corners[q][c], ...stage.uv[q][c], stage.kinds[q]);
    triangles.push(4 * q, 4 * q + 1, 4 * q + 2, 4 * q, 4 * q + 2, 4 * q + 3);
  }
  buffer(gl, gl.ARRAY_BUFFER, new Float32Array(floats));
  attribute(gl, 0, 3, gl.FLOAT, 24, 0, false);
  attribute(gl, 1, 2, gl.FLOAT, 24, 12, false);
  attribute(gl, 2, 1, gl.FLOAT, 24, 20, false);
  buffer(gl, gl.ELEMENT_ARRAY_BUFFER, new Uint16Array(triangles));
  gl.bindVertexArray(null);
  return { array, count: triangles.length };
}

/** @param {WebGL2RenderingContext} gl @param {number} target @param {ArrayBufferView<ArrayBuffer>} data */
function buffer(gl, target, data) {
  gl.bindBuffer(target, gl.createBuffer());
  gl.bufferData(target, data, gl.STATIC_DRAW);
}

/**
 * @param {WebGL2RenderingContext} gl @param {number} number @param {number} width @param {number} kind
 * @param {number} stride @param {number} offset @param {boolean} normalised
 */
function attribute(gl, number, width, kind, stride, offset, normalised) {
  gl.enableVertexAttribArray(number);
  gl.vertexAttribPointer(number, width, kind, normalised, stride, offset);
}

/** @param {WebGL2RenderingContext} gl @param {ImageBitmap} image */
export function skinTexture(gl, image) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, image);
  gl.generateMipmap(gl.TEXTURE_2D);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAX_LOD, 3); // the films' four levels: charts' gaps stay apart
  return texture;
}

/** @param {WebGL2RenderingContext} gl @param {Float32Array} data @param {number} width @param {number} height */
export function numbers(gl, data, width, height) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, data);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  return texture;
}

/** @param {WebGL2RenderingContext} gl @param {import("./doc.js").Stage} stage */
export function tileTexture(gl, stage) {
  const across = stage.panel.length;
  const deep = stage.panel[0].length;
  const data = new Float32Array(4 * across * deep);
  for (let j = 0; j < deep; ++j) {
    for (let i = 0; i < across; ++i) data.set([stage.panel[i][j], ...stage.arrow[i][j], 0], 4 * (j * across + i));
  }
  return numbers(gl, data, across, deep);
}

/** @param {WebGL2RenderingContext} gl @param {number} texels */
export function shadowMap(gl, texels) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, texels, texels);
  for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  const frame = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
  gl.drawBuffers([gl.NONE]);
  gl.readBuffer(gl.NONE);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return { texture, frame };
}
