// What viewers of recordings make of one: reads it by the packages that they are built on, and compares each message with what its
// writer says of it.   check.mjs FILE
import { MessageReader } from "@foxglove/omgidl-serialization";
import { parseIDL } from "@foxglove/omgidl-parser";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import * as fzstd from "fzstd";
import { open, readFile } from "node:fs/promises";

const decompressHandlers = { zstd: (bytes, size) => fzstd.decompress(bytes, new Uint8Array(Number(size))) };
const text = new TextDecoder();
const path = process.argv[2];
const problems = [];
const tally = new Map();

class FileReadable {
  constructor(handle) {
    this.handle = handle;
  }
  async size() {
    return BigInt((await this.handle.stat()).size);
  }
  async read(offset, length) {
    const bytes = new Uint8Array(Number(length));
    await this.handle.read(bytes, 0, bytes.length, Number(offset));
    return bytes;
  }
}

// ---- the same value, in two spellings: `is` is what the viewer has, `should` is Skein's JSON.

let declarations;

function fail(place, is, should) {
  const show = (value) => JSON.stringify(value, (_, x) => (typeof x === "bigint" ? `${x}n` : x));
  throw new Error(`${place}: is ${show(is)}, and should be ${show(should)}`);
}

function same(place, is, should) {
  if (typeof is === "bigint") return is === BigInt(should) || Number(is) === should || fail(place, is, should);
  return is === should || fail(place, is, should);
}

// Members and collections that cannot stand where they are lie in a struct of their own.
function unwrapped(value) {
  const isWrapper = value && typeof value === "object" && !Array.isArray(value) && !ArrayBuffer.isView(value);
  return isWrapper && "value" in value ? value.value : value;
}

function memberOf(is, name) {
  return name in is ? is[name] : is[`_${name}`];
}

function compareNumber(place, is, should) {
  const special = { NaN: Number.NaN, Infinity: Infinity, "-Infinity": -Infinity };
  if (should in special) return Object.is(is, special[should]) || fail(place, is, should);
  return same(place, is, should);
}

function compareList(place, element, is, should) {
  if (is.length !== should.length) fail(`${place}.length`, is.length, should.length);
  should.forEach((value, i) => compare(`${place}[${i}]`, element, is[i], value));
}

function compare(place, type, is, should) {
  switch (type.kind) {
    case "OptionalMember":
      if (is && typeof is === "object" && ("value" in is || "nothing" in is)) is = is.value;
      if (should === null || should === undefined) return is === undefined || fail(place, is, should);
      return compare(place, type.elements[0], is, should);
    case "Char":
    case "WideChar":
      return same(place, is, should.codePointAt(0));
    case "String":
    case "Boolean":
      return same(place, is, should);
    case "WideString":
      return same(place, new TextDecoder("utf-16le").decode(unwrapped(is)), should);
    case "LongDouble":
      return compareQuad(place, is, should);
    case "Sequence":
    case "Array":
      return compareList(place, type.elements[0], unwrapped(is), should);
    case "Map": {
      const pairs = unwrapped(is);
      if (pairs.length !== should.length) fail(`${place}.length`, pairs.length, should.length);
      return should.forEach((pair, i) => {
        compare(`${place}[${i}].key`, type.elements[0], unwrapped(pairs[i].key), pair.key);
        compare(`${place}[${i}].value`, type.elements[1], pairs[i].value, pair.value);
      });
    }
    case "Declared":
      return compareDeclared(place, declarations.get(type.name), is, should);
    case "Reference":
      return undefined;
    default:
      return compareNumber(place, is, should);
  }
}

// IEEE 754 binary128.
function compareQuad(place, is, should) {
  const high = BigInt(is.high);
  const exponent = Number((high >> 48n) & 0x7fffn);
  const fraction = ((high & 0xffffffffffffn) << 64n) | BigInt(is.low);
  const size = exponent === 0 ? 0 : (1 + Number(fraction) / 2 ** 112) * 2 ** (exponent - 16383);
  return same(place, high >> 63n ? -size : size, Number(should));
}

function compareDeclared(place, declaration, is, should) {
  if (ArrayBuffer.isView(unwrapped(is))) return tally.set("octets", (tally.get("octets") ?? 0) + 1);
  switch (declaration.kind) {
    case "Enumeration":
      return same(place, is | 0, declaration.values.find((value) => value.name === should).value | 0);
    case "Bitmask": {
      const bits = should.map((name) => 1n << BigInt(declaration.values.find((value) => value.name === name).value));
      return same(place, BigInt(is), bits.reduce((all, bit) => all | bit, 0n));
    }
    case "Bitset":
      return compareBitset(place, declaration, BigInt(is), should);
    case "Union":
      return compareUnion(place, declaration, "bytes" in is ? unwrapped(is) : is, should);
    default:
      for (const member of declaration.members) {
        compare(`${place}.${member.name}`, member.type, memberOf(is, member.name), should[member.name]);
      }
      return undefined;
  }
}

function compareBitset(place, declaration, is, should) {
  let shift = 0n;
  for (const field of declaration.fields) {
    const width = BigInt(field.width);
    const raw = (is >> shift) & ((1n << width) - 1n);
    shift += width;
    if (field.name === "") continue;
    const signed = ["Int8", "Short", "Long", "LongLong"].includes(field.kind);
    const value = signed ? BigInt.asIntN(field.width, raw) : raw;
    same(`${place}.${field.name}`, field.kind === "Boolean" ? value === 1n : value, should[field.name]);
  }
}

function compareUnion(place, declaration, is, should) {
  if ("$discriminator" in is) compare(`${place}.$discriminator`, declaration.discriminator[0], is.$discriminator, should._d);
  const member = declaration.members.find((each) => each.name in should);
  if (member) compare(`${place}.${member.name}`, member.type, memberOf(is, member.name), should[member.name]);
}

// Version 1.0 of the reader expects all members of a @mutable type.
const readsOptional = !JSON.parse(
  await readFile(new URL("node_modules/@foxglove/omgidl-serialization/package.json", import.meta.url)),
).version?.startsWith("1.0.");

function lacksMember(type, value) {
  switch (type.kind) {
    case "OptionalMember":
      return (value ?? null) !== null && lacksMember(type.elements[0], value);
    case "Sequence":
    case "Array":
      return value.some((each) => lacksMember(type.elements[0], each));
    case "Map":
      return value.some((pair) => lacksMember(type.elements[1], pair.value));
    case "Declared": {
      const { extensibility, members } = declarations.get(type.name);
      return members.some((member) => {
        const held = value[member.name] ?? null;
        if (held === null) return extensibility === "Mutable" && member.type.kind === "OptionalMember";
        return lacksMember(member.type, held);
      });
    }
    default:
      return false;
  }
}

function isBeyondReader(name, value) {
  return !readsOptional && declarations.get(name).extensibility === "Mutable" && lacksMember({ kind: "Declared", name }, value);
}

// ---- the file

async function streamed() {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true, includeChunks: true });
  const counts = {};
  reader.append(await readFile(path));
  for (let record; (record = reader.nextRecord()); ) counts[record.type] = (counts[record.type] ?? 0) + 1;
  if (!reader.done()) problems.push("read as a stream, the file does not end");
  return counts;
}

const handle = await open(path, "r");
const reader = await McapIndexedReader.Initialize({ readable: new FileReadable(handle), decompressHandlers });
const attachments = new Map();
for await (const attachment of reader.readAttachments({ validateCrcs: true })) attachments.set(attachment.name, attachment);
const attached = (name) => JSON.parse(text.decode(attachments.get(name).data));
declarations = new Map(attached("types.json").declarations.map((each) => [each.name, each]));
const values = attached("values.json");

const readers = new Map();
function readerOf(channel) {
  if (!readers.has(channel.id)) {
    const schema = reader.schemasById.get(channel.schemaId);
    readers.set(channel.id, schema && new MessageReader(schema.name, parseIDL(text.decode(schema.data))));
  }
  return readers.get(channel.id);
}

let messages = 0;
for await (const message of reader.readMessages({ validateCrcs: true })) {
  messages++;
  const channel = reader.channelsById.get(message.channelId);
  const expected = values[message.sequence - 1];
  try {
    const decoder = readerOf(channel);
    if (!decoder) {
      tally.set("without schema", (tally.get("without schema") ?? 0) + 1);
      continue;
    }
    if (isBeyondReader(expected.type, expected.value)) {
      tally.set("beyond this version", (tally.get("beyond this version") ?? 0) + 1);
      continue;
    }
    const value = decoder.readMessage(message.data);
    compare(channel.topic, { kind: "Declared", name: expected.type }, value, expected.value);
    tally.set("decoded", (tally.get("decoded") ?? 0) + 1);
  } catch (error) {
    problems.push(`${channel.topic}: ${error.message}`);
  }
}
await handle.close();

const counts = await streamed();
const expectCount = (what, is, should) => is === should || problems.push(`${is} ${what}, and should be ${should}`);
expectCount("messages by the index", messages, values.length);
expectCount("messages by statistics", Number(reader.statistics?.messageCount), values.length);
expectCount("chunks as a stream", counts.Chunk, reader.statistics?.chunkCount);
expectCount("attachments as a stream", counts.Attachment, reader.statistics?.attachmentCount);
expectCount("metadata as a stream", counts.Metadata, reader.statistics?.metadataCount);

console.log([...tally].map(([what, count]) => `${count} ${what}`).join(", "));
for (const problem of problems) console.error(problem);
process.exit(problems.length === 0 ? 0 : 1);
