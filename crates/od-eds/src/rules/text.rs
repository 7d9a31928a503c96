//! Rules whose codes begin with 01: text and INI structure: rules reported by the reader of lines, keys and encodings.

use alloc::format;
use alloc::string::String;

use crate::fact::Key;
use crate::finding::{
    Finding, Fixability, Form, Rule,
    Severity::{Error, Warning},
};
use crate::fix::Fix;
use crate::scan::encoding::Encoding;
use crate::scan::lines;
use crate::scan::section::{Text, TextSection};
use crate::span::{Span, Spanned};

table! {
    W0101
    W0102
    W0103
    W0104
    W0105
    W0106
    W0107
    W0108
    W0109
    W0110
    I0111
    W0112
    E0113 (xdd)
    E0114 (xdd)
    E0115 (xdd)
    W0116 (example)
    E0117
    E0118
    E0119 (example)
    W0120 (xdd)
    E0121 (xdd)
    W0122
    W0123 (xdd)
    E0124 (xdd)
}

pub(crate) static W0101: Rule = Rule {
    title: "line is not a section, a key or a comment",
    why: "Most EDS parsers stop at such a line. odkit ignores it.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "`{given}` is not a section, a `key=value` line or a comment",
    help: "start the line with `;`{fix}, or remove it",
    also: &[W0101_NO_SIGN],
    ..Rule::of("W0101")
};

/// Sentence for a key and a value without an equals sign.
const W0101_NO_SIGN: Form = Form {
    says: "`=` is missing; odkit reads `{name}={given}`",
    help: "write `{name}={given}`{fix}",
};

pub(crate) fn w0101_no_sign(at: Span, key: &str, value: &str) -> Finding {
    let finding = W0101.at(at).form(&W0101_NO_SIGN).fact("name", key);
    finding
        .fact("given", value)
        .fix(Fix::safe().replace(at, "="))
}

pub(crate) fn w0101_unknown_line(line: Spanned<&str>) -> Finding {
    let finding = W0101.given(&line);
    finding.fix(Fix::safe().comment_out(line.span))
}

pub(crate) static W0102: Rule = Rule {
    title: "line has no key before the `=`",
    why: "A tool can read a value only by its key. odkit ignores the line.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "`{given}` has no key before the `=`",
    help: "start the line with `;`{fix}, or write a key before the `=`",
    ..Rule::of("W0102")
};

pub(crate) fn w0102_no_key(line: Spanned<&str>) -> Finding {
    let finding = W0102.given(&line);
    finding.fix(Fix::safe().comment_out(line.span))
}

pub(crate) static W0103: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "section header has no closing bracket",
    why: "Most EDS parsers stop at such a line. odkit assumes that the header ends with its line.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "header of section `{given}` has no closing bracket",
    help: "write `[{given}]`{fix}",
    ..Rule::of("W0103")
};

pub(crate) fn w0103_no_closing_bracket(line: Span, name: Spanned<&str>) -> Finding {
    let fix = Fix::safe().replace(name.span, format!("{}]", *name));
    W0103.at(line).fact("given", *name).fix(fix)
}

pub(crate) static W0104: Rule = Rule {
    title: "text after a section header",
    why: "Most EDS parsers stop at such a line. odkit ignores the text.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "`{given}` follows the section header `[{name}]`",
    help: "move the text to a line that starts with `;`{fix}",
    ..Rule::of("W0104")
};

/// The finding about text after a header; the fix makes it a comment below the header.
pub(crate) fn w0104_text_after_header(name: &str, text: Spanned<&str>) -> Finding {
    let comment = lines::comment(text.trim_start_matches([';', '#']));
    let comment = format!("\n{comment}");
    let finding = W0104.given(&text).fact("name", name);
    finding.fix(Fix::safe().replace(text.span, comment))
}

pub(crate) static W0105: Rule = Rule {
    title: "key before the first section",
    why: "A key belongs to a section. odkit keeps the key and ignores it.",
    source: "CiA 306-1, file format",
    says: "`{name}` is before the first section",
    help: "write a section header such as `[FileInfo]` above it",
    ..Rule::of("W0105")
};

pub(crate) fn w0105_key_before_section(line: Span, key: &str) -> Finding {
    W0105.at(line).fact("name", key)
}

pub(crate) static W0106: Rule = Rule {
    title: "duplicate section",
    why: "Tools differ in which of the two they use. odkit uses the first and keeps both.",
    source: "CiA 306-1, file format",
    says: "duplicate section [{name}]",
    help: "move the keys of both into one section",
    ..Rule::of("W0106")
};

/// The label at the first of two.
const FIRST: &str = "first defined here";

pub(crate) fn w0106_duplicate_section(second: &TextSection<'_>, first: Span) -> Finding {
    let finding = W0106.at(second.header).fact("name", &*second.name.value);
    finding.related(first, FIRST)
}

pub(crate) static W0107: Rule = Rule {
    title: "duplicate key",
    why: "Some tools stop at a second line with the same key. odkit uses the first.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Either,
    says: "duplicate key `{name}`",
    help: "remove `{name}={given}`{fix}",
    ..Rule::of("W0107")
};

pub(crate) fn w0107_duplicate_key(first: &Text<'_>, key: &Text<'_>, value: &Text<'_>) -> Finding {
    // A tool that distinguishes capital and small letters may only know the second key.
    let fix = if first.value == key.value {
        Fix::safe()
    } else {
        Fix::unsafe_fix()
    };
    repeated(&W0107, first.span, key, value).fix(fix.remove_line(key.span))
}

/// A finding about a second line of a key.
fn repeated(rule: &'static Rule, first: Span, key: &Text<'_>, value: &Text<'_>) -> Finding {
    rule.at(key.span)
        .fact("name", &*key.value)
        .fact("given", &*value.value)
        .related(first, FIRST)
}

pub(crate) static W0108: Rule = Rule {
    title: "`:` instead of `=`",
    why: "Only some EDS parsers accept it. odkit reads it as `=`.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "`{name}` is followed by `:` instead of `=`",
    help: "write `{name}={given}`{fix}",
    ..Rule::of("W0108")
};

pub(crate) fn w0108_colon(colon: Span, key: &str, value: &str) -> Finding {
    let finding = W0108.at(colon).fact("name", key).fact("given", value);
    finding.fix(Fix::safe().replace(colon, "="))
}

pub(crate) static W0109: Rule = Rule {
    title: "comment after a value",
    why: "A comment needs a line of its own; after a value it is part of the value. odkit ignores it if the value is a number.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "`{given}` has a comment after the value",
    help: "write `{key={right}}`, and the comment on the next line{fix}",
    also: &[W0109_OTHER],
    ..Rule::of("W0109")
};

/// Sentence for a key outside the object sections.
const W0109_OTHER: Form = Form {
    help: "write `{name}={right}`, and the comment on the next line{fix}",
    ..Form::OWN
};

/// The finding about a value outside the object sections with a comment after it.
pub(crate) fn w0109_comment_after_other(name: &str, given: &Text<'_>, value: &str) -> Finding {
    let finding = comment_after(given, value).form(&W0109_OTHER);
    finding.fact("name", name)
}

/// The finding about a value with a comment after it.
pub(crate) fn w0109_comment_after_value(key: Key, given: &Text<'_>, value: &str) -> Finding {
    comment_after(given, value).key(key)
}

/// The finding whose fix gives the comment its own line.
fn comment_after(given: &Text<'_>, value: &str) -> Finding {
    let comment = given.get(value.len()..).unwrap_or_default().trim();
    let comment = format!(
        "{value}\n{}",
        lines::comment(&comment[comment.len().min(1)..])
    );
    W0109
        .given(given)
        .fact("right", value)
        .fix(Fix::safe().replace(given.span, comment))
}

pub(crate) static W0110: Rule = Rule {
    title: "section header without a name",
    why: "A tool can find a section only by its name. odkit keeps the section and ignores it.",
    source: "CiA 306-1, file format",
    says: "section header has no name",
    help: "write a name between the brackets",
    ..Rule::of("W0110")
};

pub(crate) fn w0110_header_without_name(header: Span) -> Finding {
    W0110.at(header)
}

pub(crate) static I0111: Rule = Rule {
    title: "file is not ASCII",
    why: "CiA 306 requires ASCII. odkit also reads UTF-8, UTF-16 and Windows-1252, with or without a byte order mark; many EDS parsers read only one of them.",
    source: "CiA 306-1, file format",
    says: "file is encoded in {encoding}",
    help: "save the file as ASCII if a tool cannot read it",
    also: &[I0111_MARKED],
    ..Rule::of("I0111")
};

/// The sentence for a file with a byte order mark.
const I0111_MARKED: Form = Form {
    says: "file is encoded in {encoding}, with a byte order mark",
    ..Form::OWN
};

/// The finding about a file that is not ASCII, at the first such character.
pub(crate) fn i0111_not_ascii(first: Span, encoding: Encoding, marked: bool) -> Finding {
    let finding = I0111.at(first).fact("encoding", encoding.name());
    if marked {
        finding.form(&I0111_MARKED)
    } else {
        finding
    }
}

pub(crate) static W0112: Rule = Rule {
    title: "byte is not valid in the file's encoding",
    why: "The file mixes two encodings, or is incomplete. odkit reads the byte as Windows-1252 in UTF-8 and as U+FFFD in UTF-16; a file that odkit writes keeps it.",
    source: "CiA 306-1, file format",
    says: "invalid {encoding} byte",
    help: "retype the character, or save the file in one encoding",
    ..Rule::of("W0112")
};

/// The finding about the first byte that is not valid in the encoding.
pub(crate) fn w0112_encoding(at: Span, encoding: Encoding) -> Finding {
    W0112.at(at).fact("encoding", encoding.name())
}

pub(crate) static E0113: Rule = Rule {
    title: "XML is not well-formed",
    why: "No tool can read such a file, and odkit reads nothing of it.",
    source: "XML 1.0",
    says: "XML is not well-formed: {error}",
    help: "correct the XML",
    ..Rule::of("E0113")
};

/// The finding about the place where the XML breaks, in the words of its parser.
#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn e0113_xml_not_well_formed(at: Span, error: &str) -> Finding {
    E0113.at(at).fact("error", error)
}

pub(crate) static E0114: Rule = Rule {
    title: "object of an XDD has no valid index",
    why: "An index has four hexadecimal digits and a sub-index two, without `0x`. odkit leaves the element out.",
    source: "CiA 311, CANopenObject",
    says: "`{given}` is not a valid {name}",
    help: "write {digits} hexadecimal digits",
    also: &[E0114_MISSING],
    ..Rule::of("E0114")
};

/// The sentence for an element without the attribute.
const E0114_MISSING: Form = Form {
    says: "{name} is missing",
    ..Form::OWN
};

/// The finding about an index or a sub-index: an attribute that is not valid, or is missing.
#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn e0114_xdd_index_not_valid(
    element: Span,
    name: &str,
    given: Option<&Spanned<String>>,
    digits: usize,
) -> Finding {
    let finding = match given {
        Some(given) => E0114.given(given),
        None => E0114.at(element).form(&E0114_MISSING),
    };
    finding.fact("name", name).fact("digits", digits)
}

pub(crate) static E0115: Rule = Rule {
    title: "object of an XDD refers to a missing parameter",
    why: "The parameter gives type, access and default value of the object. odkit reads only the attributes of the object itself.",
    source: "CiA 311, CANopenObject",
    says: "no parameter has the uniqueID `{given}`",
    help: "add the parameter, or write its attributes at the object",
    ..Rule::of("E0115")
};

#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn e0115_xdd_parameter_missing(at: Span, id: &str) -> Finding {
    E0115.at(at).fact("given", id)
}

pub(crate) static W0116: Rule = Rule {
    title: "too many findings of one rule",
    why: "A file with this many findings of one rule is likely not a device description. odkit reports the first 10,000 findings of each rule and counts the others.",
    source: "odkit, limits of a report",
    example: "a file with 10,001 lines that are neither a section, a key nor a comment",
    says: "{rule} has {more:more finding|more findings} from here on",
    help: "correct the first {kept:finding|findings}, then check the file again",
    ..Rule::of("W0116")
};

/// The finding that further findings of a rule are left out.
pub(crate) fn w0116_too_many_findings(
    first: Span,
    rule: &str,
    kept: usize,
    more: usize,
) -> Finding {
    let finding = W0116.at(first).fact("rule", rule);
    finding.fact("kept", kept).fact("more", more)
}

pub(crate) static E0117: Rule = Rule {
    buildable: true,
    title: "duplicate key with another value",
    why: "Tools differ in which of the two they use, and some stop. odkit uses the first.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Unsafe,
    says: "duplicate key `{name}` with another value",
    help: "remove `{name}={given}`{fix}, or the other line",
    ..Rule::of("E0117")
};

/// The finding about a second line of a key; a tool that uses the last one reads another value.
pub(crate) fn e0117_duplicate_key_differs(
    first: Span,
    key: &Text<'_>,
    value: &Text<'_>,
) -> Finding {
    repeated(&E0117, first, key, value).fix(Fix::unsafe_fix().remove_line(key.span))
}

pub(crate) static E0118: Rule = Rule {
    title: "mark of a merge conflict",
    why: "The file has two versions of the lines around the mark, and most tools stop at it. odkit ignores the mark and reads both versions.",
    source: "CiA 306-1, file format; git, merge conflicts",
    says: "`{given}` is a mark of a merge conflict that is not resolved",
    help: "keep one of the two versions, and remove the lines with `<<<<<<<`, `=======` and `>>>>>>>`",
    ..Rule::of("E0118")
};

pub(crate) fn e0118_merge_conflict(line: Spanned<&str>) -> Finding {
    E0118.given(&line)
}

pub(crate) static E0119: Rule = Rule {
    title: "file is too large to be a device file",
    why: "No device file is that large, and a tool that reads it may run out of memory or never end. odkit ignores a line that is too long, and everything from the line on at which a file has too many; of an XML file it reads nothing.",
    source: "odkit, limits of a file",
    example: "a line of 2 MB, or a file with 200,000 sections",
    says: "the {part} has more than {most} {of}",
    help: "remove what does not describe the device",
    ..Rule::of("E0119")
};

/// The finding about a part of a file with more than `most` bytes, lines or sections.
pub(crate) fn e0119_too_large(at: Span, part: &str, most: usize, of: &str) -> Finding {
    let finding = E0119.at(at).fact("part", part);
    finding.fact("most", most).fact("of", of)
}

pub(crate) static W0120: Rule = Rule {
    title: "value of an XDD has no objectType",
    why: "The schema requires the attribute, and a tool that checks a file by it rejects the file. odkit assumes 7 (VAR).",
    source: "CiA 311, CANopenObject and CANopenSubObject",
    says: "attribute objectType is missing",
    help: "add `objectType=\"7\"` (VAR), or `objectType=\"2\"` for a DOMAIN",
    ..Rule::of("W0120")
};

#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn w0120_object_type_missing(at: Span) -> Finding {
    W0120.at(at)
}

pub(crate) static E0121: Rule = Rule {
    buildable: true,
    title: "word of an XDD in other capitals than in the schema",
    why: "XML distinguishes capital and small letters: a tool that checks a file by the schema rejects the file. odkit reads the word of the schema.",
    source: "CiA 311, accessType, access and PDOmapping",
    fixability: Fixability::Safe,
    says: "`{given}` is not a word of the schema",
    help: "write `{right}`{fix}",
    ..Rule::of("E0121")
};

/// The finding about an attribute whose value is this word of the schema in other capitals.
#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn e0121_capitals(given: &Spanned<String>, right: &str) -> Finding {
    let fix = Fix::safe().replace(given.span, right);
    E0121.given(given).fact("right", right).fix(fix)
}

pub(crate) static W0122: Rule = Rule {
    title: "control character in the text",
    why: "A terminal or a tool acts on the character instead of showing it, or stops at it. odkit keeps it in the file and shows it as a code.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Unsafe,
    says: "control character {code:02X}h",
    help: "remove the control characters of the line{fix}",
    ..Rule::of("W0122")
};

pub(crate) fn w0122_control_character(at: Span, c: char) -> Finding {
    W0122.at(at).fact("code", u32::from(c))
}

pub(crate) static W0123: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "attribute or text of an XDD is not as in the schema",
    why: "A tool that reads a file by the schema rejects the file. odkit ignores the value, except hexadecimal digits.",
    source: "CiA 311, schema of the profiles; ISO 15745-1",
    fixability: Fixability::Either,
    says: "`{given}` is not a valid {name}",
    help: "write {right}{fix}",
    also: &[W0123_MISSING, W0123_ELEMENT],
    ..Rule::of("W0123")
};

/// Sentence for an attribute that the schema requires.
const W0123_MISSING: Form = Form {
    says: "attribute {name} of {element} is missing",
    help: "add `{name}=\"…\"`",
};

/// The finding about an attribute, or the text of an element, that has another form than the one in words.
#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn w0123_attribute_not_valid(
    given: &Spanned<String>,
    name: &str,
    right: String,
) -> Finding {
    let finding = W0123.given(given).fact("name", name);
    finding.fact("right", right)
}

#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn w0123_attribute_missing(at: Span, element: &str, name: &str) -> Finding {
    let finding = W0123.at(at).form(&W0123_MISSING).fact("name", name);
    finding.fact("element", element).severity_of(Warning)
}

/// Sentence for an element that the schema does not have.
const W0123_ELEMENT: Form = Form {
    says: "{element} is not an element of the schema",
    help: "write an element of the schema, or remove it",
};

#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn w0123_element_unknown(at: Span, element: &str) -> Finding {
    let finding = W0123.at(at).form(&W0123_ELEMENT).fact("element", element);
    finding.severity_of(Warning)
}

pub(crate) static E0124: Rule = Rule {
    buildable: true,
    title: "uniqueID of an XDD does not belong to one element",
    why: "A tool cannot tell which element is meant, and a tool that checks a file by the schema rejects the file. odkit uses the first of two elements.",
    source: "CiA 311, uniqueID and references to it",
    says: "uniqueID `{given}` belongs to another element, too",
    help: "give each element a uniqueID of its own",
    also: &[E0124_MISSING],
    ..Rule::of("E0124")
};

/// Sentence for a reference that leads to no element.
const E0124_MISSING: Form = Form {
    says: "no element has the uniqueID `{given}`",
    help: "write the uniqueID of an element of this file, or remove the reference",
};

#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn e0124_id_twice(given: &Spanned<String>, first: Span) -> Finding {
    E0124.given(given).related(first, FIRST)
}

#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn e0124_id_missing(given: &Spanned<String>) -> Finding {
    E0124.given(given).form(&E0124_MISSING)
}
