// The filter of the console: `node:5 sdo`, `185:7FF`, `position`, `!hb`, `(emcy or err) tx`.
// Terms side by side must all hold; `or` and parentheses combine them.

import { hexBytes } from '../format';
import { T } from '../texts';
import type { Frame } from './ring';

/** Returns whether a frame passes. If its text is not known, terms that need it let it pass. */
type Test = (frame: Frame, words: string | undefined) => boolean;

export interface Filter {
  test: Test;
  /** Whether the filter checks the texts of frames. */
  needsWords: boolean;
}

type ParsedFilter = { filter: Filter | null } | { error: string; at: number };

interface Token {
  text: string;
  at: number;
}

const SERVICES: Record<string, string[]> = {
  nmt: ['NMT'], sync: ['SYNC'], time: ['TIME'], emcy: ['EMCY'], pdo: ['PDO'], sdo: ['SDO'], hb: ['HB'], heartbeat: ['HB'],
  lss: ['LSS'], err: ['ERR'], error: ['ERR'], can: ['CAN'],
};

const hex = (text: string): number | null => (/^(?:0x)?[0-9a-f]{1,8}h?$/i.test(text) ? Number.parseInt(text.replace(/^0x/i, ''), 16) : null);

class Failure {
  constructor(
    readonly error: string,
    readonly at: number,
  ) {}
}

export function parseFilter(text: string): ParsedFilter {
  try {
    const parser = new Parser(tokens(text), text.length);
    if (parser.isEmpty) return { filter: null };
    const test = parser.any();
    parser.end();
    return { filter: { test, needsWords: parser.needsWords } };
  } catch (failure) {
    if (failure instanceof Failure) return { error: failure.error, at: failure.at };
    throw failure;
  }
}

function tokens(text: string): Token[] {
  // Wireshark allows blanks around its operators.
  const list: Token[] = [];
  const pattern = /\s*([()!|]|-(?=\S)|[^\s()!|"]*"[^"]*("?)|[a-z_]+\.[a-z_]+\s*(?:==|!=)\s*[^\s()|]+|[^\s()|]+)/giy;
  while (pattern.lastIndex < text.trimEnd().length) {
    const start = pattern.lastIndex;
    const match = pattern.exec(text);
    if (!match?.[1]) throw new Failure(T.filter.unreadable, start);
    const at = match.index + match[0].length - match[1].length;
    if (match[1].includes('"') && match[2] === '') throw new Failure(T.filter.quote, at);
    list.push({ text: match[1], at });
  }
  return list;
}

class Parser {
  needsWords = false;
  private place = 0;

  constructor(
    private readonly list: Token[],
    private readonly length: number,
  ) {}

  get isEmpty(): boolean {
    return this.list.length === 0;
  }

  private peek(): string | undefined {
    return this.list[this.place]?.text.toLowerCase();
  }

  any(): Test {
    let test = this.all();
    while (this.peek() === 'or' || this.peek() === '|') {
      this.place += 1;
      const left = test;
      const right = this.all();
      test = (frame, words) => left(frame, words) || right(frame, words);
    }
    return test;
  }

  private all(): Test {
    const tests: Test[] = [];
    for (let next = this.peek(); next !== undefined && next !== 'or' && next !== '|' && next !== ')'; next = this.peek()) {
      if (next === 'and') this.place += 1;
      tests.push(this.one());
    }
    if (tests.length === 0) throw new Failure(T.filter.missing, this.list[this.place]?.at ?? this.length);
    return tests.length === 1 ? tests[0]! : (frame, words) => tests.every((test) => test(frame, words));
  }

  private one(): Test {
    const token = this.list[this.place];
    if (!token) throw new Failure(T.filter.missing, this.length);
    this.place += 1;
    const text = token.text.toLowerCase();
    if (text === '!' || text === '-' || text === 'not') {
      const before = this.needsWords;
      this.needsWords = false;
      const inner = this.one();
      const open = this.needsWords;
      this.needsWords ||= before;
      return (frame, words) => (open && words === undefined) || !inner(frame, words);
    }
    if (text === '(') {
      const inner = this.any();
      if (this.peek() !== ')') throw new Failure(T.filter.unclosed, token.at);
      this.place += 1;
      return inner;
    }
    if (text === ')') throw new Failure(T.filter.unopened, token.at);
    return this.term(token);
  }

  end(): void {
    const rest = this.list[this.place];
    if (rest) throw new Failure(T.filter.unopened, rest.at);
  }

  private term({ text, at }: Token): Test {
    const field = /^([a-z_]+(?:\.[a-z_]+)?)\s*(:|==|!=)\s*(.*)$/i.exec(text);
    if (field && !/^[0-9a-f]{1,3}$/i.test(field[1]!)) return this.field(field[1]!.toLowerCase(), field[2]!, field[3]!, at + text.length - field[3]!.length, at);
    const plain = text.toLowerCase();
    if (plain.includes(',') && !plain.includes('"')) {
      const parts = text.split(',').filter((part) => part !== '');
      if (parts.length === 0) throw new Failure(T.filter.missing, at);
      const tests = parts.map((part) => this.term({ text: part, at: at + text.indexOf(part) }));
      return (frame, words) => tests.some((test) => test(frame, words));
    }
    const service = SERVICES[plain] ?? /^r?pdo[1-4]$/.test(plain);
    if (service) return Array.isArray(service) ? (frame) => service.includes(frame.tag.service) : (frame) => frame.tag.text.toLowerCase() === plain;
    if (plain === 'tx' || plain === 'rx') return (frame) => frame.fromPage === (plain === 'tx');
    if (/^(11|29)-?bit$/.test(plain)) return (frame) => frame.extended === plain.startsWith('29');
    if (plain === 'rtr') return (frame) => frame.remote;
    if (plain === 'abort') return (frame) => frame.tag.service === 'SDO' && frame.data[0] === 0x80;
    const masked = /^(?:0x)?([0-9a-f]{1,8}):(?:0x)?([0-9a-f]{1,8})$/i.exec(plain);
    if (masked) {
      const mask = Number.parseInt(masked[2]!, 16);
      const wanted = Number.parseInt(masked[1]!, 16) & mask;
      return (frame) => (frame.id & mask) === wanted;
    }
    const range = /^(?:0x)?([0-9a-f]{1,8})(?:-|\.\.)(?:0x)?([0-9a-f]{1,8})$/i.exec(plain);
    if (range) {
      const [low, high] = [Number.parseInt(range[1]!, 16), Number.parseInt(range[2]!, 16)];
      if (low > high) throw new Failure(T.filter.range, at);
      return (frame) => frame.id >= low && frame.id <= high;
    }
    // Three digits are a CAN-ID, four an object, more a CAN-ID of 29 bits.
    if (/^(?:0x)?[0-9a-f]{3}h?$/i.test(plain) && /\d/.test(plain)) return this.identifier(plain, at);
    if (/^(?:0x)?[0-9a-f]{4}h?(?:[:.][0-9a-f]{1,2})?$/i.test(plain) && /\d/.test(plain)) return this.object(plain, at);
    if (/^(?:0x)?[0-9a-f]{5,8}h?$/i.test(plain) && /\d/.test(plain)) return this.identifier(plain, at);
    // A number in no known form is a mistake, not a word of a text.
    if (/^\d/.test(plain) && !/^[0-9a-f]{1,2}$/.test(plain)) throw new Failure(T.filter.number, at);
    return this.words(text);
  }

  private field(name: string, operator: string, value: string, at: number, start: number): Test {
    const test = this.fieldTest(name, value, at, start);
    return operator === '!=' ? (frame, words) => !test(frame, words) : test;
  }

  private fieldTest(name: string, value: string, at: number, start: number): Test {
    if (value === '') throw new Failure(T.filter.value(name), at);
    switch (name) {
      case 'node':
      case 'canopen.node_id': {
        const node = /^0x/i.test(value) ? hex(value) : /^\d+$/.test(value) ? Number(value) : null;
        if (node === null || node < 1 || node > 127) throw new Failure(T.filter.node, at);
        // An NMT command may address all nodes.
        return (frame) => frame.node === node || (frame.tag.service === 'NMT' && frame.node === 0);
      }
      case 'id':
      case 'cob':
      case 'can.id':
      case 'canopen.cob_id':
        return /[:,-]|\.\./.test(value) ? this.term({ text: value, at }) : this.identifier(value, at);
      case 'data': {
        const digits = value.replace(/["\s]/g, '').toUpperCase();
        if (!/^([0-9A-F]{2}|\.\.|XX)+$/.test(digits)) throw new Failure(T.filter.bytes, at);
        const wanted = digits.match(/../g)!.map((pair) => (/[.X]/.test(pair) ? null : Number.parseInt(pair, 16)));
        return (frame) => wanted.every((byte, i) => (byte === null ? i < frame.data.length : frame.data[i] === byte));
      }
      case 'object':
      case 'index':
        return this.object(value, at);
      case 'len':
      case 'dlc': {
        if (!/^[0-8]$/.test(value)) throw new Failure(T.filter.length, at);
        return (frame) => frame.dlc === Number(value);
      }
      case 'text':
        return this.words(value);
      default:
        throw new Failure(T.filter.field(name), start);
    }
  }

  private identifier(text: string, at: number): Test {
    const id = hex(text);
    if (id === null || id > 0x1fffffff) throw new Failure(T.filter.id, at);
    // More than three digits are 29 bits, so that 00000181 is another CAN-ID than 181.
    const isLong = text.replace(/^0x|h$/gi, '').length > 4;
    return (frame) => frame.id === id && (frame.extended || !isLong);
  }

  /** SDO frames about an object, and frames whose text names it. */
  private object(text: string, at: number): Test {
    const match = /^(?:0x)?([0-9a-f]{4})h?(?:[:.](?:0x)?([0-9a-f]{1,2})h?)?$/i.exec(text);
    if (!match) throw new Failure(T.filter.object, at);
    const first = Number.parseInt(match[1]!, 16) * 256;
    if (match[2] === undefined) return ({ object }) => object !== null && object >= first && object < first + 256;
    const key = first + Number.parseInt(match[2], 16);
    return (frame) => frame.object === key;
  }

  private words(text: string): Test {
    this.needsWords = true;
    const wanted = text.replaceAll('"', '').toLowerCase();
    return (frame, words) => words === undefined || words.toLowerCase().includes(wanted) || hexBytes(frame.data).toLowerCase().includes(wanted);
  }
}
