// node read.mjs FILE.mcap…: reads every message as Foxglove does and prints, for each file, its topics as JSON:
// {topic: {schema, messages, last}}, where `last` is the last message, with byte arrays as their lengths.
import {parse} from "@foxglove/rosmsg";
import {MessageReader} from "@foxglove/rosmsg2-serialization";
import {open} from "./open.mjs";

async function topicsOf(file) {
  const reader = await open(file);
  const topics = {};
  const decoders = new Map();
  for (const channel of reader.channelsById.values()) {
    const schema = reader.schemasById.get(channel.schemaId);
    const definition = parse(new TextDecoder().decode(schema.data), {ros2: true});
    decoders.set(channel.id, new MessageReader(definition));
    topics[channel.topic] = {schema: schema.name, messages: 0, last: null};
  }
  for await (const message of reader.readMessages({validateCrcs: true})) {
    const topic = topics[reader.channelsById.get(message.channelId).topic];
    topic.messages += 1;
    topic.last = decoders.get(message.channelId).readMessage(message.data);
  }
  return topics;
}

const plain = (key, value) =>
  value instanceof Uint8Array || value instanceof Int8Array ? value.length
    : ArrayBuffer.isView(value) ? Array.from(value) : value;
const files = {};
for (const file of process.argv.slice(2)) files[file] = await topicsOf(file);
console.log(JSON.stringify(files, plain));
