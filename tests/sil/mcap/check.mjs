// Holds the recording of a run against @mcap/core, and its content against the schemas in it and those of Foxglove.
//
//   node check.mjs RUN.mcap STEPS      STEPS: that the run had, each with a frame
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import idl from "@foxglove/omgidl-parser";
import serialization from "@foxglove/omgidl-serialization";
import foxglove from "@foxglove/schemas/jsonschema.js";
import Ajv from "ajv";

import { readAsStream, readByIndex } from "./reading.mjs";

const bytes = readFileSync(process.argv[2]);
const steps = Number(process.argv[3]);
const { reader, messages } = await readByIndex(bytes);
const stream = readAsStream(bytes);
const channels = [...reader.channelsById.values()];
const schemaOf = (channel) => reader.schemasById.get(channel.schemaId);
const textOf = (data) => new TextDecoder("utf-8", { fatal: true }).decode(data);
const messagesOf = (topic) => messages.filter((message) => reader.channelsById.get(message.channelId).topic === topic);

// The samples of a topic, by the schema in the file.
function samplesOf(topic) {
  const schema = schemaOf(channels.find((channel) => channel.topic === topic));
  const decoder = new serialization.MessageReader(schema.name, idl.parseIDL(textOf(schema.data)));
  return messagesOf(topic).map((message) => decoder.readMessage(message.data));
}
const samples = Object.fromEntries(channels.filter((channel) => channel.messageEncoding === "cdr")
  .map(({ topic }) => [topic, samplesOf(topic)]));
const jsonOf = (topic) => messagesOf(topic).map((message) => JSON.parse(textOf(message.data)));

const sum = (numbers) => numbers.reduce((a, b) => a + b, 0);

test("every channel has a schema, in the encoding of its messages", () => {
  const schemaEncodings = { cdr: "omgidl", json: "jsonschema" };
  assert.ok(channels.length > 0);
  for (const channel of channels) {
    assert.ok(channel.messageEncoding in schemaEncodings, channel.topic);
    assert.equal(schemaOf(channel)?.encoding, schemaEncodings[channel.messageEncoding], channel.topic);
  }
  // A file without its end has those before the first chunk only.
  assert.deepEqual(stream.channelsById, reader.channelsById);
  assert.deepEqual(stream.schemasById, reader.schemasById);
});

test("the stream has the messages that the indices have", () => {
  const inOrderOfTime = [...stream.messages].sort((a, b) => Number(a.logTime - b.logTime));
  assert.ok(stream.isWhole);
  assert.deepEqual(messages, inOrderOfTime);
});

test("the statistics are those of the messages", () => {
  const { statistics } = reader;
  assert.equal(statistics.messageCount, BigInt(messages.length));
  assert.equal(statistics.channelCount, channels.length);
  assert.equal(statistics.schemaCount, reader.schemasById.size);
  assert.equal(statistics.chunkCount, stream.chunks.length);
  assert.equal(statistics.messageStartTime, messages[0].logTime);
  assert.equal(statistics.messageEndTime, messages.at(-1).logTime);
  for (const { id, topic } of channels)
    assert.equal(statistics.channelMessageCounts.get(id) ?? 0n, BigInt(messagesOf(topic).length), topic);
});

test("chunks and their index have the times of their messages", () => {
  assert.ok(stream.chunks.length > 1);
  assert.equal(reader.chunkIndexes.length, stream.chunks.length);
  for (const [i, chunk] of stream.chunks.entries()) {
    const times = chunk.messages.map((message) => message.logTime).sort((a, b) => Number(a - b));
    for (const stated of [chunk.record, reader.chunkIndexes[i]])
      assert.deepEqual([stated.messageStartTime, stated.messageEndTime], [times[0], times.at(-1)]);
  }
});

test("the samples are those of the run", () => {
  assert.ok(steps > 0);
  for (const topic of ["lidar_frame", "navigation", "step", "attitude", "telemetry", "step_done", "truth"])
    assert.deepEqual(samples[`sil/${topic}`].map(({ k }) => k), [...Array(steps).keys()], topic);
  for (const topic of ["/lidar/points", "/tf", "/figures"]) assert.equal(messagesOf(topic).length, steps, topic);
  assert.deepEqual(new Set(samples["sil/hello"].map(({ role }) => role)), new Set([0, 1]));
  // What a step and its answer announce.
  const announced = (topic, field) => sum(samples[topic].map((sample) => sample[field]));
  assert.equal(samples["sil/lidar_frame"].length, announced("sil/step", "frames"));
  assert.equal(samples["sil/command"].length, announced("sil/step", "commands"));
  assert.equal(samples["sil/event"].length, announced("sil/step_done", "events"));
  assert.equal(messagesOf("/events").length, samples["sil/event"].length);
  assert.ok(samples["sil/event"].length > 0);
  // The flight program says hello with 0 before it knows the run.
  const runs = new Set(Object.values(samples).flat().map((sample) => sample.run_id).filter((id) => id !== 0));
  assert.equal(runs.size, 1);
});

test("the JSON messages are as the schema in the file and Foxglove's own say", () => {
  const ajv = new Ajv({ strict: false });
  for (const channel of channels.filter(({ messageEncoding }) => messageEncoding === "json")) {
    const { name, data } = schemaOf(channel);
    const inFile = JSON.parse(textOf(data));
    const published = name.startsWith("foxglove.") ? [foxglove[name.slice("foxglove.".length)]] : [];
    for (const schema of [{ ...inFile, additionalProperties: false }, ...published]) {
      const isValid = ajv.compile(schema);
      for (const message of jsonOf(channel.topic))
        assert.ok(isValid(message), `${channel.topic}: ${ajv.errorsText(isValid.errors)}`);
    }
  }
  for (const figures of jsonOf("/figures")) {
    assert.equal(typeof figures.valid, "boolean");
    assert.equal(typeof figures.verified, "boolean");
  }
});

test("the frames have the returns that the point clouds show", () => {
  const clouds = jsonOf("/lidar/points");
  for (const [i, { rays, fov_urad, ranges }] of samples["sil/lidar_frame"].entries()) {
    const slope = Math.tan(0.5e-6 * fov_urad);
    const points = Buffer.from(clouds[i].data, "base64");
    let at = 0;
    for (let ray = 0; ray < rays * rays; ++ray) {
      if (ranges[ray] === 0) continue;
      const [x, y, z] = [0, 4, 8].map((offset) => points.readFloatLE(at + offset));
      const [row, column] = [Math.floor(ray / rays), ray % rays];
      assert.ok(Math.abs(Math.hypot(x, y, z) - ranges[ray] / 128) < 1e-4);
      assert.ok(Math.abs(x / y - slope * ((2 * column + 1) / rays - 1)) < 1e-5);
      assert.ok(Math.abs(z / y - slope * (1 - (2 * row + 1) / rays)) < 1e-5);
      at += clouds[i].point_stride;
    }
    assert.ok(at > 0);
    assert.equal(at, points.length);
  }
});

// As a killed program leaves the file.
test("a file that was cut keeps the messages of its whole chunks", async () => {
  const whole = reader.chunkIndexes.map(({ chunkStartOffset, chunkLength, messageIndexLength }) => {
    const start = Number(chunkStartOffset), end = start + Number(chunkLength);
    return { start, end, indexEnd: end + Number(messageIndexLength) };
  });
  const cuts = whole.flatMap(({ start, end, indexEnd }) => [
    start, start + 5, Math.floor((start + end) / 2), end - 1, end, Math.floor((end + indexEnd) / 2), indexEnd,
  ]);
  cuts.push(Number(reader.dataEndOffset) + 4, Number(reader.footer.summaryStart) + 100, bytes.length - 1);
  for (const cut of cuts) {
    const cutOff = bytes.subarray(0, cut), found = readAsStream(cutOff);
    const expected = stream.chunks.filter((_, i) => whole[i].end <= cut).flatMap((chunk) => chunk.messages);
    assert.equal(found.isWhole, false, `cut at ${cut}`);
    assert.deepEqual(found.messages, expected, `cut at ${cut}`);
    await assert.rejects(readByIndex(cutOff), `cut at ${cut}`);
  }
});

test("a changed byte is found", async () => {
  const changedAt = (offset) => bytes.map((byte, i) => (i === offset ? byte ^ 1 : byte));
  for (const { chunkStartOffset, chunkLength, messageIndexLength } of reader.chunkIndexes) {
    const end = Number(chunkStartOffset + chunkLength);
    const inChunk = changedAt(Math.floor((Number(chunkStartOffset) + end) / 2));
    assert.throws(() => readAsStream(inChunk), /Incorrect chunk CRC/);
    await assert.rejects(readByIndex(inChunk), /Incorrect chunk CRC/);
    await assert.rejects(readByIndex(changedAt(end + Math.floor(Number(messageIndexLength) / 2))));
  }
  const inSummary = changedAt(Number(reader.footer.summaryStart) + 100);
  await assert.rejects(readByIndex(inSummary), /Incorrect summary CRC/);
});
