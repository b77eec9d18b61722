// Prints an MCAP file as JSON, read as viewers do, by its index, the definitions in its schemas and Foxglove's decoder:
// node read_mcap.mjs FILE.mcap
import { readFileSync } from "node:fs";
import { McapIndexedReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";

const bytes = readFileSync(process.argv[2]);
const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + length))),
};
const reader = await McapIndexedReader.Initialize({ readable });
const topics = {};
const decoders = new Map();
for (const channel of reader.channelsById.values()) {
    const schema = reader.schemasById.get(channel.schemaId);
    decoders.set(channel.id, new MessageReader(parse(new TextDecoder().decode(schema.data), { ros2: true })));
    topics[channel.topic] = {
        unit: channel.metadata.get("unit"), schema: schema.name, definition: schema.encoding, encoding: channel.messageEncoding,
        counted: Number(reader.statistics.channelMessageCounts.get(channel.id)), time_ns: [], value: [],
    };
}
for await (const message of reader.readMessages({ validateCrcs: true })) {
    const topic = topics[reader.channelsById.get(message.channelId).topic];
    topic.time_ns.push(Number(message.logTime));
    topic.value.push(decoders.get(message.channelId).readMessage(message.data).data);
}
console.log(JSON.stringify({
    topics, chunks: reader.chunkIndexes.length, profile: reader.header.profile,
    messages: Number(reader.statistics.messageCount), first_ns: Number(reader.statistics.messageStartTime), last_ns: Number(reader.statistics.messageEndTime),
}));
