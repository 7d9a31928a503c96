// What the package `canopen` of npm reads of files: their names come on standard input, their folder is the argument.
const { readFileSync } = require('fs');
const { join } = require('path');
const { Eds } = require('canopen');
const rawToType = require('canopen/source/functions/raw_to_type');

const BASIC = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 21, 22, 24, 25, 27];
const PLAIN = { '\t': '\\t', '\r': '\\r', '\n': '\\n', "'": "\\'", '"': '\\"', '\\': '\\\\' };

/** As `escape_default` of Rust. */
function escaped(text) {
    const one = (c) => PLAIN[c] || (c >= ' ' && c <= '~' ? c : `\\u{${c.codePointAt(0).toString(16)}}`);
    return [...text].map(one).join('');
}

function shown(value, type) {
    if (typeof value === 'boolean') return `i${value ? 1 : 0}`;
    if (typeof value === 'bigint') return `i${value}`;
    if (typeof value === 'number') return `${[8, 17].includes(type) ? 'r' : 'i'}${value}`;
    return Buffer.isBuffer(value) ? `b${value.toString('hex')}` : `t${escaped(String(value))}`;
}

function value(entry) {
    const type = entry.dataType;
    if (!BASIC.includes(type) || entry.objectType === 2) return '-';
    try {
        return shown(type === 11 ? entry._raw.toString() : rawToType(entry._raw, type), type);
    } catch {
        return '-';
    }
}

function limit(number) {
    if (number === undefined) return '';
    return Number.isFinite(number) ? `i${BigInt(Math.trunc(number))}` : '-';
}

function line(index, sub, entry) {
    const at = `\t${index.toString(16).toUpperCase().padStart(4, '0')}\t${sub.toString(16).toUpperCase()}`;
    const fields = [entry.dataType, escaped(String(entry.accessType)), '-', value(entry)];
    return [at, ...fields, limit(entry.lowLimit), limit(entry.highLimit), '-', `t${escaped(String(entry.parameterName))}`].join('\t');
}

for (const name of readFileSync(0, 'utf8').split('\n').filter((name) => name)) {
    const lines = [`${name}\tread`];
    try {
        for (const entry of Eds.fromFile(join(process.argv[2], name)).values()) {
            const members = entry._subObjects ? Object.entries(entry._subObjects) : [[0, entry]];
            lines.push(...members.map(([sub, member]) => line(entry.index, Number(sub), member)));
        }
        console.log(lines.join('\n'));
    } catch (error) {
        console.log(`${name}\terror\t${escaped(String(error.message))}`);
    }
}
