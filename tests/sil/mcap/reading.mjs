// Reads MCAP files with @mcap/core, in its two ways. Both throw if a record or a checksum is wrong.
import crc from "@foxglove/crc";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";

// The whole file by its summary and indices: the reader, and all messages in the order of their times.
export async function readByIndex(bytes) {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  };
  const reader = await McapIndexedReader.Initialize({ readable });
  const messages = [];
  for await (const message of reader.readMessages({ validateCrcs: true })) messages.push(message);
  // The reader leaves this checksum to its users.
  if (crc.crc32(bytes.subarray(0, Number(reader.dataEndOffset))) !== reader.dataSectionCrc)
    throw new Error("Incorrect data section CRC");
  return { reader, messages };
}

// From the first byte on, as far as the file goes: channels and schemas before the first chunk, the chunks with their
// messages, all messages in the order of the file, and whether the file has its end.
export function readAsStream(bytes) {
  const reader = new McapStreamReader({ includeChunks: true, validateCrcs: true });
  reader.append(bytes);
  const channelsById = new Map(), schemasById = new Map(), chunks = [];
  for (let record; (record = reader.nextRecord());) {
    if (record.type === "Channel" && chunks.length === 0) channelsById.set(record.id, record);
    if (record.type === "Schema" && chunks.length === 0) schemasById.set(record.id, record);
    if (record.type === "Chunk") chunks.push({ record, messages: [] });
    if (record.type === "Message") chunks.at(-1).messages.push(record);
  }
  const messages = chunks.flatMap((chunk) => chunk.messages);
  return { channelsById, schemasById, chunks, messages, isWhole: reader.done() };
}
