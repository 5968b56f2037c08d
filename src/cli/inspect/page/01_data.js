"use strict";
// What the program found: the JSON of the page, and the arrays in it.

const page = JSON.parse(document.getElementById("data").textContent);

async function inflated(text) {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
}

// Typed arrays by name.
const arrays = {};
async function loadArrays() {
  const buffer = await inflated(page.binary.deflated);
  const types = { Float32Array, Int8Array, Uint32Array, Int32Array, Uint16Array, Int16Array, Uint8Array };
  for (const [name, [type, offset, length]] of Object.entries(page.binary.arrays))
    arrays[name] = new types[type](buffer, offset, length);
  page.binary = null;
}

// Places in 16 bits a coordinate, of which one takes `stride` numbers.
function place(code, array, i, stride = 3) {
  return [0, 1, 2].map((k) => code.lower[k] + (array[stride * i + k] / 65535) * (code.upper[k] - code.lower[k]));
}
const fromLogarithm = (code) => (code === 0 ? 0 : 2 ** (code / 1024 - 32));

function decodedPlaces(code, array, stride, count = array.length / stride) {
  const out = new Float32Array(3 * count);
  for (let i = 0; i < count; ++i)
    for (let k = 0; k < 3; ++k)
      out[3 * i + k] = code.lower[k] + (array[stride * i + k] / 65535) * (code.upper[k] - code.lower[k]);
  return out;
}

// The path of a photon: places from the lamp on, and which of them the photon lies at.
function trail(index) {
  const begin = arrays.trailStarts[index], end = arrays.trailStarts[index + 1], points = [], specular = [];
  for (let i = begin; i < end; ++i) {
    points.push(place(page.air, arrays.trailPoints, i));
    specular.push((arrays.trailFlags[i] & 1) !== 0);
  }
  return { points, specular, photon: arrays.trailPhotons[index] };
}

// What a pixel sees and where its light comes from.
function pixelLight(x, y) {
  const pixel = y * page.film.width + x, trailPoints = [];
  for (let i = arrays.pixelStarts[pixel]; i < arrays.pixelStarts[pixel + 1]; ++i)
    trailPoints.push(place(page.air, arrays.pixelTrails, i));
  const pixels = page.film.width * page.film.height;
  const sources = (array, stride) => {
    const each = array.length / stride / pixels, list = [];
    for (let i = pixel * each; i < (pixel + 1) * each; ++i) {
      const value = fromLogarithm(array[stride * i + 3]);
      if (value > 0) list.push({ p: place(page.air, array, i, stride), value, at: stride * i });
    }
    return list;
  };
  // Of the ends of gather rays also which lamp shines on them, and how much of their light that is.
  const gather = sources(arrays.pixelGather, 9).map((end) => ({ ...end,
    lamp: place(page.air, arrays.pixelGather.subarray(end.at + 4, end.at + 7), 0),
    fromLamp: fromLogarithm(arrays.pixelGather[end.at + 7]), emitter: arrays.pixelGather[end.at + 8] }));
  // Where shadow rays go, the likeliest lamp first; of an environment some directions that they take.
  const most = arrays.pixelLamps.length / 2 / pixels, directions = most > 0 ? arrays.pixelTowards.length / 3 / (most * pixels) : 0, lamps = [];
  for (let i = pixel * most; i < (pixel + 1) * most; ++i) {
    if (arrays.pixelLamps[2 * i + 1] === 0) continue;
    const towards = Array.from({ length: directions }, (_, k) => [...arrays.pixelTowards.subarray(3 * (directions * i + k), 3 * (directions * i + k + 1))]);
    lamps.push({ emitter: arrays.pixelLamps[2 * i], chance: arrays.pixelLamps[2 * i + 1] / 65535, towards: towards.filter((w) => dot(w, w) > 0).map(unit) });
  }
  return { lamps, trail: trailPoints, seen: arrays.pixelSeen[pixel] === 1, reach: arrays.pixelReach[pixel],
           gather, direct: sources(arrays.pixelDirect, 4) };
}

const photonCount = () => arrays.photons.length / 3;
const photonPlace = (i) => [...arrays.photons.subarray(3 * i, 3 * i + 3)];
const luminance = (r, g, b) => 0.2126 * r + 0.7152 * g + 0.0722 * b;
const photonPower = (i) => luminance(...arrays.photonPowers.subarray(3 * i, 3 * i + 3));
