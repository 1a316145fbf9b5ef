/* Binary messages of the server: wavetank/web/packets.py says how they are laid out. */
"use strict";

const ARRAYS = { float32: Float32Array, float64: Float64Array, uint8: Uint8Array, uint16: Uint16Array, uint32: Uint32Array };

/** The JSON of a packet, each of its arrays as a member of that name. */
function unpack(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const packet = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  let place = 4 + length;
  for (const each of packet.arrays) {
    const kind = ARRAYS[each.type];
    packet[each.name] = new kind(buffer, place, each.count);
    place += Math.ceil(each.count * kind.BYTES_PER_ELEMENT / 8) * 8;
  }
  return packet;
}
