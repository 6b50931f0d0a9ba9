// Reads the packed frames of a run that view/recording_pack.cpp writes.
//
// The inflated data are: the length of a head (4 bytes, little-endian), the head in JSON, the
// stream. The stream has the times of all frames as doubles (little-endian), then the channels one
// after another in the form of their packing. "constant" has no data in the stream. "exact" has
// doubles. "steps" has integer numbers of quanta: their differences of the given order (the first
// `order` ones are differences to 0), each as a zigzag varint. The first `missing` values are
// unknown (NaN) and are not in the stream.

import { Frames } from './frames';
import type { Channel, Machine, MachineEvent } from './machine';

export interface PackedChannel extends Channel {
  packing: 'constant' | 'exact' | 'steps';
  missing?: number;
  value?: number;
  quantum?: number;
  order?: number;
}

export interface RecordingHead {
  machine: Machine;
  events: MachineEvent[];
  frames: number;
  channels: PackedChannel[];
}

/** Reads values from bytes in sequence. */
class Reader {
  private place = 0;
  private readonly view: DataView;
  constructor(private readonly bytes: Uint8Array) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }
  double(): number {
    const value = this.view.getFloat64(this.place, true);
    this.place += 8;
    return value;
  }
  /** An integer below 2^53 in absolute value. */
  integer(): number {
    let value = 0;
    let scale = 1;
    for (;;) {
      if (this.place >= this.bytes.length) throw new Error('the recording ends too early');
      const byte = this.bytes[this.place++];
      value += (byte & 127) * scale;
      if (byte < 128) break;
      scale *= 128;
    }
    return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
  }
  get atEnd(): boolean {
    return this.place === this.bytes.length;
  }
}

/** Unpacks a whole inflated recording. */
export function unpack(bytes: Uint8Array): Frames {
  const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true);
  const text = new TextDecoder().decode(bytes.subarray(4, 4 + length));
  return unpackStream(JSON.parse(text) as RecordingHead, bytes.subarray(4 + length));
}

export function unpackStream(head: RecordingHead, bytes: Uint8Array): Frames {
  const frames = new Frames(
    head.machine,
    head.channels.map(({ name, unit, hidden }) => ({ name, unit, hidden })),
  );
  const reader = new Reader(bytes);
  const times = new Float64Array(head.frames);
  for (let k = 0; k < times.length; ++k) times[k] = reader.double();
  const columns = head.channels.map((channel) => column(channel, head.frames, reader));
  if (!reader.atEnd) throw new Error('the recording is longer than its channels');
  frames.adopt(times, columns);
  frames.events.push(...head.events);
  return frames;
}

function column(channel: PackedChannel, count: number, reader: Reader): Float64Array {
  const values = new Float64Array(count);
  const missing = channel.missing ?? 0;
  values.fill(NaN, 0, missing);
  if (channel.packing === 'constant') {
    values.fill(channel.value ?? NaN, missing);
  } else if (channel.packing === 'exact') {
    for (let k = missing; k < count; ++k) values[k] = reader.double();
  } else {
    const quantum = channel.quantum ?? 1;
    // The last differences of order 0 to `order`, which are summed up.
    const sums = new Array<number>((channel.order ?? 0) + 1).fill(0);
    for (let k = missing; k < count; ++k) {
      sums[sums.length - 1] = reader.integer();
      for (let i = sums.length - 2; i >= 0; --i) sums[i] += sums[i + 1];
      values[k] = sums[0] * quantum;
    }
  }
  return values;
}

/**
 * FNV-1a, 32 bits, of a text in ASCII, as command/view/page_file.cpp has it: each byte is taken up one to one, so a text of
 * which one byte is another has another one.
 */
export function checksum(text: string): string {
  let value = 0x811c9dc5;
  for (let k = 0; k < text.length; ++k) value = Math.imul(value ^ text.charCodeAt(k), 0x01000193);
  return (value >>> 0).toString(16).padStart(8, '0');
}

/** Throws unless the text is the one of which this is the checksum. */
export function requireChecksum(text: string, written: string | undefined): void {
  const found = checksum(text);
  if (found === written) return;
  throw new Error(
    `the file has been changed: the checksum of its recording is ${found} and must be ${written ?? 'there'}; ` +
      'take a copy of the file, or make it anew with "sheave view"',
  );
}

export function fromBase64(text: string): Uint8Array {
  const binary = atob(text.trim());
  const bytes = new Uint8Array(binary.length);
  for (let k = 0; k < binary.length; ++k) bytes[k] = binary.charCodeAt(k);
  return bytes;
}

export async function inflate(bytes: Uint8Array): Promise<Uint8Array> {
  const stream = new Blob([bytes as Uint8Array<ArrayBuffer>])
    .stream()
    .pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
