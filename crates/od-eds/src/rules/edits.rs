//! Rules whose codes begin with 07: edits of a macro call or a variant: rules that `patch` reports.

use alloc::string::ToString;
use od_model::{DataType, Kind, ObjectCode};

use crate::fact::{Fact, Key};
use crate::finding::{Finding, Form, Rule};
use crate::patch::target::Target;
use crate::rules::values::shared::{NOT_VALID, WHOLE};
use crate::span::{Span, Spanned};

table! {
    E0701 (example)
    E0702 (example)
    E0703 (example)
    E0704 (example)
    E0705 (example)
    E0706 (example)
    E0707 (example)
    E0708 (example)
    E0709 (example)
    E0710 (example)
    E0711 (example)
    E0712 (example)
}

pub(crate) static E0701: Rule = Rule {
    title: "edit of a missing object",
    why: "A variant changes and removes only objects that its base has. odkit reports the statement and ignores it.",
    source: "odkit, object_dictionary!",
    example: "modify 0x2000 { default = 7 }      // the EDS has no 2000h",
    says: "{object} does not exist",
    help: "list the objects of a file with `odkit dump`",
    also: &[E0701_NEAR, E0701_NEAR_NAMELESS, E0701_FIRST, E0701_MEMBERS],
    ..Rule::of("E0701")
};

/// Sentence for an object whose index differs in one digit.
const E0701_NEAR: Form = Form {
    help: "write `{meant}` (\"{name}\")",
    ..Form::OWN
};
/// The same, if the similar object has no name.
const E0701_NEAR_NAMELESS: Form = Form {
    help: "write `{meant}`",
    ..Form::OWN
};
/// Sentence for a target with no similar object.
const E0701_FIRST: Form = Form {
    help: "write `add {target} {{ … }}` first",
    ..Form::OWN
};
const E0701_MEMBERS: Form = Form {
    help: "write one of the sub-indices {subs}",
    ..Form::OWN
};

pub(crate) fn e0701_object_missing(target: &Spanned<Target>) -> Finding {
    let finding = target.finding(&E0701, target.span);
    finding.fact("object", Fact::Index(target.index))
}

/// The same, with the object that the name probably means.
pub(crate) fn e0701_near(target: &Spanned<Target>, meant: Target, name: &str) -> Finding {
    let finding = e0701_object_missing(target).fact("meant", meant.to_string());
    // An `add` without a name has its target instead.
    if name == Target::object(meant.index).to_string() {
        finding.form(&E0701_NEAR_NAMELESS)
    } else {
        finding.form(&E0701_NEAR).fact("name", name)
    }
}

/// The same, in a description without objects.
pub(crate) fn e0701_first(target: &Spanned<Target>) -> Finding {
    let object = Target::object(target.index);
    e0701_object_missing(target)
        .form(&E0701_FIRST)
        .fact("target", object.to_string())
}

/// The finding about a sub-index that the object lacks; it has those that `subs` names.
pub(crate) fn e0701_sub_index(target: &Spanned<Target>, subs: &str) -> Finding {
    let finding = target.finding(&E0701, target.span);
    let finding = finding.fact("object", target.address());
    match subs {
        "" => finding
            .form(&E0701_FIRST)
            .fact("target", target.to_string()),
        subs => finding.form(&E0701_MEMBERS).fact("subs", subs),
    }
}

pub(crate) static E0702: Rule = Rule {
    title: "added object already exists",
    why: "A variant adds only objects that its base lacks. odkit reports the statement and ignores it.",
    source: "odkit, object_dictionary!",
    example: "add 0x1017 { name = \"Heartbeat\"; type = u16 }   // the EDS has 1017h",
    says: "{object} already exists",
    help: "write `modify {target} {{ … }}` to change it",
    ..Rule::of("E0702")
};

pub(crate) fn e0702_object_exists(target: &Spanned<Target>) -> Finding {
    target
        .named(&E0702, target.span)
        .fact("object", target.shown())
}

pub(crate) static E0703: Rule = Rule {
    title: "added sub-object has no object",
    why: "A sub-object belongs to an object, which has to exist before it. odkit reports the statement and ignores it.",
    source: "odkit, object_dictionary!",
    example: "add 0x2000sub1 { name = \"Order\"; type = u8 }",
    says: "`{target}` needs object {object}, which does not exist",
    help: "write `add 0x{object:04X} {{ code = record; name = \"…\" }}` first",
    ..Rule::of("E0703")
};

pub(crate) fn e0703_sub_object_without_object(target: &Spanned<Target>) -> Finding {
    target
        .named(&E0703, target.span)
        .fact("object", Fact::Index(target.index))
}

pub(crate) static E0704: Rule = Rule {
    title: "object has no sub-objects",
    why: "Only an ARRAY or a RECORD has sub-objects. odkit reports the statement and ignores it.",
    source: "odkit, object_dictionary!",
    example: "add 0x1017sub1 { name = \"Second\"; type = u16 }   // 1017h is a VAR",
    says: "{object} has object code {code} and no sub-objects",
    help: "write `0x{object:04X}` for its value",
    also: &[E0704_ADDED],
    ..Rule::of("E0704")
};

/// A sub-object that is added.
const E0704_ADDED: Form = Form {
    help: "remove the object, and add it with `code = record`",
    ..Form::OWN
};

pub(crate) fn e0704_object_without_sub_objects(
    target: &Spanned<Target>,
    code: ObjectCode,
) -> Finding {
    target
        .finding(&E0704, target.span)
        .fact("object", Fact::Index(target.index))
        .fact("code", code)
}

/// The same, about an `add`.
pub(crate) fn e0704_added(target: &Spanned<Target>, code: ObjectCode) -> Finding {
    e0704_object_without_sub_objects(target, code).form(&E0704_ADDED)
}

pub(crate) static E0705: Rule = Rule {
    title: "added object has no name",
    why: "The handle in Rust gets its name from the name of the object.",
    source: "odkit, object_dictionary!",
    example: "add 0x2000 { type = u16 }",
    says: "`add {target}` lacks {ParameterName}",
    help: "write `{ParameterName=\"…\"}`",
    ..Rule::of("E0705")
};

pub(crate) fn e0705_name_missing(target: &Spanned<Target>) -> Finding {
    target.named(&E0705, target.span)
}

pub(crate) static E0706: Rule = Rule {
    title: "added value has no type",
    why: "The handle in Rust gets its type from the type of the value.",
    source: "odkit, object_dictionary!",
    example: "add 0x2000 { name = \"Gain\" }",
    says: "`add {target}` lacks {DataType}",
    help: "write `{DataType={type}}` ({type}), or another type",
    ..Rule::of("E0706")
};

pub(crate) fn e0706_type_missing(target: &Spanned<Target>) -> Finding {
    target
        .named(&E0706, target.span)
        .fact("type", DataType::Unsigned16)
}

pub(crate) static E0707: Rule = Rule {
    title: "value of an edit is not valid for its type",
    why: "A default or a limit is a value of its type. odkit keeps the value of the base.",
    source: "odkit, object_dictionary!",
    example: "add 0x2000 { name = \"Gain\"; type = u8; default = 300 }",
    says: NOT_VALID,
    help: "write {form}",
    also: &[WHOLE],
    ..Rule::of("E0707")
};

/// The finding about a value, as it is given, that is not valid for the type.
pub(crate) fn e0707_value_not_valid(
    target: &Spanned<Target>,
    at: Span,
    key: Key,
    given: &str,
    data_type: DataType,
) -> Finding {
    let finding = target.finding(&E0707, at).key(key);
    let finding = finding.fact("type", data_type);
    match data_type.kind() {
        Kind::Record => finding.form(&WHOLE).fact("right", DataType::Unsigned32),
        _ => finding
            .fact("given", given)
            .fact("form", Fact::FormOf(data_type)),
    }
}

pub(crate) static E0708: Rule = Rule {
    title: "value of the base is not valid for the new type",
    why: "An edit that changes the type also has to change the values that are not valid for it. odkit leaves the value out.",
    source: "odkit, object_dictionary!",
    example: "modify 0x1000 { type = u8 }          // its default is 0x20196",
    says: "{key} `{given}` of the base is not a valid {type}",
    help: "write {key} too: {form}, or `none`",
    ..Rule::of("E0708")
};

pub(crate) fn e0708_value_of_base_not_valid(
    target: &Spanned<Target>,
    at: Span,
    key: Key,
    given: &str,
    data_type: DataType,
) -> Finding {
    target
        .finding(&E0708, at)
        .key(key)
        .fact("given", given)
        .fact("type", data_type)
        .fact("form", Fact::FormOf(data_type))
}

pub(crate) static E0709: Rule = Rule {
    title: "sub-object with an object code",
    why: "Only an object has an object code; a sub-object is always a VAR. odkit ignores the code.",
    source: "odkit, object_dictionary!",
    example: "modify 0x1018sub1 { code = var }",
    says: "`{target}` is a sub-object and has no {ObjectType}",
    help: "write `0x{object:04X} {{ {ObjectType=record} }}`",
    ..Rule::of("E0709")
};

pub(crate) fn e0709_sub_object_with_object_code(target: &Spanned<Target>, at: Span) -> Finding {
    target
        .named(&E0709, at)
        .fact("object", Fact::Index(target.index))
}

pub(crate) static E0710: Rule = Rule {
    title: "value of an object with sub-objects",
    why: "Type, access, default and limits belong to the sub-objects. odkit ignores the value.",
    source: "odkit, object_dictionary!",
    example: "modify 0x1018 { default = 5 }        // a RECORD has no value",
    says: "{object} has sub-objects, and {key} belongs to one of them",
    help: "write the sub-object, such as `0x{object:04X}sub1`",
    ..Rule::of("E0710")
};

pub(crate) fn e0710_value_of_object_with_sub_objects(
    target: &Spanned<Target>,
    at: Span,
    key: Key,
) -> Finding {
    target
        .finding(&E0710, at)
        .key(key)
        .fact("object", Fact::Index(target.index))
}

pub(crate) static E0711: Rule = Rule {
    title: "field does not apply to the type",
    why: "A PDO carries values of fixed length, only strings and DOMAINs have a capacity, and only numbers have limits. odkit ignores the field.",
    source: "odkit, object_dictionary!; CiA 301, data types and PDO mapping parameter",
    example: "add 0x2000 { name = \"Order\"; type = u8; capacity = 8 }",
    says: "{type} has a fixed length, and no {key}",
    help: "remove {key}, or write another type, such as `{DataType=OCTET_STRING}`",
    also: &[E0711_MAPPABLE, E0711_LIMIT],
    ..Rule::of("E0711")
};

/// A string or DOMAIN that is to be mapped.
const E0711_MAPPABLE: Form = Form {
    says: "{type} has no fixed length and cannot be mapped into a PDO",
    help: "write `{PDOMapping=0}`, or a type of fixed length",
};

/// A limit of a string or DOMAIN.
const E0711_LIMIT: Form = Form {
    says: "{type} has no limits",
    help: "remove {key}",
};

/// The finding about a limit of a type whose values have no order.
pub(crate) fn e0711_limit(
    target: &Spanned<Target>,
    at: Span,
    key: Key,
    data_type: DataType,
) -> Finding {
    let finding = target.finding(&E0711, at).key(key);
    finding.fact("type", data_type).form(&E0711_LIMIT)
}

pub(crate) fn e0711_capacity(target: &Spanned<Target>, at: Span, data_type: DataType) -> Finding {
    let finding = target.finding(&E0711, at).key(Key::Capacity);
    finding.fact("type", data_type)
}

/// The finding about a mappable value without a fixed length.
pub(crate) fn e0711_mappable(target: &Spanned<Target>, at: Span, data_type: DataType) -> Finding {
    let finding = target.finding(&E0711, at).key(Key::PdoMapping);
    finding.fact("type", data_type).form(&E0711_MAPPABLE)
}

pub(crate) static E0712: Rule = Rule {
    title: "added object has an index of the data types",
    why: "Below 1000h CiA 301 has data types (0001h to 001Fh, 0020h to 025Fh) and reserved indices; a mapping entry such as 0005h maps a dummy. odkit ignores the statement.",
    source: "CiA 301, object dictionary structure; odkit, object_dictionary!",
    example: "add 0x0005 { name = \"Order\"; type = u8 }",
    says: "{object} is below 1000h, where CiA 301 has data types",
    help: "write an index from `0x2000` to `0x5FFF` for an object of your own",
    also: &[E0712_ZERO],
    ..Rule::of("E0712")
};

/// Sentence for index 0, which has no meaning.
const E0712_ZERO: Form = Form {
    says: "{object} is not an index of an object",
    ..Form::OWN
};

pub(crate) fn e0712_index_of_data_types(target: &Spanned<Target>) -> Finding {
    let finding = target.finding(&E0712, target.span);
    let finding = finding.fact("object", Fact::Index(target.index));
    if target.index == 0 {
        finding.form(&E0712_ZERO)
    } else {
        finding
    }
}
