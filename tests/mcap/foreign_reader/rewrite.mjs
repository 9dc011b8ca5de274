// node rewrite.mjs FILE.mcap CHUNKS.mcap PLAIN.mcap: writes the messages of a file as Foxglove does: in compressed chunks
// of 4 MB, and one after the other, without chunks.
import {writeFile} from "node:fs/promises";
import {McapWriter, TempBuffer} from "@mcap/core";
import zstd from "@foxglove/wasm-zstd";
import {open} from "./open.mjs";

const [from, chunks, plain] = process.argv.slice(2);
const compressChunk = (data) => ({compression: "zstd", compressedData: zstd.compress(data)});

async function rewrite(to, options) {
  const reader = await open(from);
  const writable = new TempBuffer();
  const writer = new McapWriter({writable, ...options});
  await writer.start(reader.header);
  const channels = new Map();
  for (const {id, schemaId, ...channel} of reader.channelsById.values()) {
    const schema = await writer.registerSchema(reader.schemasById.get(schemaId));
    channels.set(id, await writer.registerChannel({...channel, schemaId: schema}));
  }
  for await (const message of reader.readMessages())
    await writer.addMessage({...message, channelId: channels.get(message.channelId)});
  await writer.end();
  await writeFile(to, writable.get());
}

await rewrite(chunks, {chunkSize: 4 << 20, compressChunk});
await rewrite(plain, {useChunks: false});
