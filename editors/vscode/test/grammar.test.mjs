// Tests the grammar with a few lines: each token has its scope.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { test } from "node:test";

const require = createRequire(import.meta.url);
const { OnigScanner, OnigString, loadWASM } = require("vscode-oniguruma");
const { INITIAL, Registry, parseRawGrammar } = require("vscode-textmate");

const path = new URL("../syntaxes/eds.tmLanguage.json", import.meta.url);
await loadWASM(await readFile(require.resolve("vscode-oniguruma/release/onig.wasm")));
const registry = new Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new OnigScanner(patterns),
    createOnigString: (text) => new OnigString(text),
  }),
  loadGrammar: async () => parseRawGrammar(await readFile(path, "utf8"), "eds.json"),
});
const grammar = await registry.loadGrammar("source.eds");

for (const [line, text, scope] of [
  ["[1018sub1]", "1018", "entity.name.section.index"],
  ["[1018sub1]", "sub", "keyword.other.sub"],
  ["[FileInfo]", "FileInfo", "entity.name.section"],
  ["[1000] rest", " rest", "invalid.illegal.behind"],
  ["DataType=0x0007 ; four bytes", "0x0007", "constant.numeric.hex"],
  ["DataType=0x0007 ; four bytes", "; four bytes", "comment.line"],
  ["DefaultValue=$NODEID+0x180", "$NODEID", "variable.language.node-id"],
  ["LowLimit=-5", "-5", "constant.numeric.decimal"],
  ["ParameterName=Gain; 2", "Gain; 2", "string.unquoted"],
  ["AccessType=rww", "rww", "constant.language.access"],
  ["AccessType=rwx", "rwx", "invalid.illegal.access"],
  ["  ;odkit-allow=W0311 mine", "odkit-allow", "keyword.other.directive"],
  ["<<<<<<< HEAD", "<<<<<<< HEAD", "invalid.illegal.conflict"],
]) {
  test(`${line}: ${text}`, () => {
    const { tokens } = grammar.tokenizeLine(line, INITIAL);
    const found = tokens.find((token) => line.slice(token.startIndex, token.endIndex) === text);
    assert.ok(found, JSON.stringify(tokens));
    assert.ok(found.scopes.some((own) => own.startsWith(scope)), found.scopes.join(" "));
  });
}
