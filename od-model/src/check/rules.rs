//! The catalogue: every code that odkit gives, once.

use alloc::string::String;

use crate::{Diagnostic, Severity, Span};

/// One rule: what a code means, whoever found it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Rule {
    /// Stable code; the letter is the severity's.
    pub code: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// The fault in a few words.
    pub title: &'static str,
    /// Why it matters, and what odkit does about it.
    pub why: &'static str,
    /// Where it is written.
    pub source: &'static str,
}

impl Rule {
    /// A finding of this rule at `span`.
    pub fn at(&self, span: Span, message: impl Into<String>) -> Diagnostic {
        self.anywhere(message).with_span(span)
    }

    /// A finding of this rule about what is nowhere in the text.
    pub fn anywhere(&self, message: impl Into<String>) -> Diagnostic {
        match self.severity {
            Severity::Error => Diagnostic::error(self.code, message),
            Severity::Warning => Diagnostic::warning(self.code, message),
            Severity::Info => Diagnostic::info(self.code, message),
        }
    }
}

/// The rule with this code, in any case.
pub fn rule(code: &str) -> Option<&'static Rule> {
    RULES.iter().find(|r| r.code.eq_ignore_ascii_case(code))
}

/// A constant for each rule, and the table of them all.
macro_rules! rules {
    ($($name:ident $severity:ident $title:literal $why:literal $source:literal)*) => {
        $(
            pub(crate) const $name: Rule = Rule {
                code: stringify!($name),
                severity: Severity::$severity,
                title: $title,
                why: $why,
                source: $source,
            };
        )*
        /// Every rule, by ascending number.
        pub const RULES: &[Rule] = &[$($name),*];
    };
}

rules! {
    // 01: text and INI structure
    W0101 Warning "line is no section, no key and no comment"
        "Most readers stop at such a line. It is ignored here."
        "CiA 306-1, file format"
    W0102 Warning "line has no key before the `=`"
        "Nothing can ask for a value without a key. The line is ignored."
        "CiA 306-1, file format"
    W0103 Warning "section header has no closing bracket"
        "Most readers stop at such a line. The header is taken to end with its line."
        "CiA 306-1, file format"
    W0104 Warning "text behind a section header"
        "Most readers stop at such a line. The text is ignored."
        "CiA 306-1, file format"
    W0105 Warning "key before the first section"
        "A key belongs to a section. It is kept, and nothing reads it."
        "CiA 306-1, file format"
    W0106 Warning "section stands twice"
        "Readers differ in which one they take. The first counts; both are kept."
        "CiA 306-1, file format"
    W0107 Warning "key stands twice in its section"
        "Readers differ in which one they take. The first counts."
        "CiA 306-1, file format"
    W0108 Warning "`:` instead of `=`"
        "Only some readers know it. It is read as `=`."
        "CiA 306-1, file format"
    W0109 Warning "comment behind a value"
        "A comment has a line of its own; behind a value it is part of the value. Where the value is a number, it is cut off."
        "CiA 306-1, file format"
    W0110 Warning "section header without name"
        "No reader can ask for such a section. It is kept, and nothing reads it."
        "CiA 306-1, file format"
    I0111 Info "file is not ASCII"
        "CiA 306 asks for ASCII. UTF-8, UTF-16 and Windows-1252 are read, with or without a byte order mark; many readers know only one of them."
        "CiA 306-1, file format"
    W0112 Warning "byte is no character of the file's encoding"
        "Two encodings in one file, or a file that was cut. In UTF-8 the byte is read as Windows-1252, in UTF-16 as U+FFFD; a file that is written back keeps it."
        "CiA 306-1, file format"

    // 02: lists and sections
    W0201 Warning "listed object has no section"
        "A master that trusts the lists fails where the section is missing. The object is taken not to exist."
        "CiA 306-1, object lists"
    W0202 Warning "object is in no list"
        "A reader that follows the lists does not see the object. It is taken to exist."
        "CiA 306-1, object lists"
    W0203 Warning "file has no object lists"
        "A reader that follows the lists sees no objects. Every section is taken for an object."
        "CiA 306-1, object lists"
    W0204 Warning "SupportedObjects does not count its list"
        "Many readers read as many entries as it says and no more. All entries are read."
        "CiA 306-1, object lists"
    W0205 Warning "list entry is no index"
        "An entry is a number and an index, as in `1=0x1000`. It is ignored."
        "CiA 306-1, object lists"
    W0206 Warning "object is in the wrong list"
        "2000h–5FFFh belong to [ManufacturerObjects], the mandatory three to [MandatoryObjects], all others to [OptionalObjects]."
        "CiA 306-1, object lists"
    W0207 Warning "object is listed twice"
        "One entry is enough; some editors make two objects of two."
        "CiA 306-1, object lists"
    E0208 Error "sub-index without its object"
        "The section of the object itself says its code and name. The members are kept in an object without a name."
        "CiA 306-1, object sections"
    W0209 Warning "compact section without CompactSubObj"
        "[xxxxName], [xxxxValue] and [xxxxDenotation] belong to an object with CompactSubObj. The section is kept, and nothing reads it."
        "CiA 306-1, CompactSubObj"
    E0210 Error "text has no objects"
        "This is no EDS and no DCF, or an empty one."
        "CiA 306-1"

    // 03: object structure
    E0301 Error "ObjectType is no object code"
        "The object code says what kind of object it is. It is guessed from what the object has."
        "CiA 301, object codes"
    W0302 Warning "object with members has no ObjectType"
        "Without ObjectType an object is a VAR, and this one has members. It is taken for a RECORD."
        "CiA 306-1, object sections"
    E0303 Error "object or sub-index stands twice with different content"
        "Two sections for one object contradict each other; readers differ in which one they take. The first counts."
        "CiA 306-1, object sections"
    W0304 Warning "object or sub-index stands twice"
        "The sections say the same; one is enough."
        "CiA 306-1, object sections"
    E0305 Error "VAR has sub-indices"
        "Only an ARRAY or a RECORD has sub-indices. Where the object has no type of its own it is taken for a RECORD, else the sub-indices are left out."
        "CiA 301, object codes"
    W0306 Warning "ARRAY or RECORD has no members"
        "There is nothing to read or write. The object is taken not to exist."
        "CiA 306-1, object sections"
    W0307 Warning "ARRAY or RECORD has no sub-index 0"
        "A master reads sub-index 0 to learn how many members there are."
        "CiA 301, object structure"
    W0308 Warning "SubNumber does not count the sub-indices"
        "SubNumber is the number of sub-index sections, sub-index 0 included. Readers that trust it miss members."
        "CiA 306-1, object sections"
    E0309 Error "sub-index 0 is no UNSIGNED8"
        "Sub-index 0 is the highest sub-index, an UNSIGNED8, in every ARRAY and RECORD."
        "CiA 301, object structure"
    E0310 Error "sub-index 0 promises members that do not exist"
        "A master that reads up to the highest sub-index gets an abort. A value that counts entries in use may be lower than the members, never higher."
        "CiA 301, object structure"
    W0311 Warning "sub-index 0 is lower than the highest member"
        "A master that reads up to sub-index 0 never sees the members above it."
        "CiA 301, object structure"
    W0312 Warning "members of an ARRAY differ in type"
        "The members of an ARRAY are all of one type; those of a RECORD may differ."
        "CiA 301, object codes"
    W0313 Warning "CompactSubObj is no number from 1 to 254"
        "CompactSubObj is the number of members besides sub-index 0. What cannot be a sub-index is left out."
        "CiA 306-1, CompactSubObj"
    W0314 Warning "compact section names a member that does not exist"
        "The entry is left out."
        "CiA 306-1, CompactSubObj"
    W0315 Warning "ParameterName is missing"
        "Every object and every member has a name."
        "CiA 306-1, object sections"
    W0316 Warning "SubNumber is no number"
        "SubNumber is the number of sub-index sections. They are counted instead."
        "CiA 306-1, object sections"
    W0317 Warning "SubNumber is missing"
        "An object with members says how many. They are counted instead."
        "CiA 306-1, object sections"

    // 04: types, values, limits
    E0401 Error "DataType is missing"
        "Nothing is known of a value without a type. It is left out of the dictionary."
        "CiA 306-1, object sections"
    E0402 Error "DataType is no data type"
        "DataType is the index of one of CiA 301's types. The value is left out of the dictionary."
        "CiA 301, data types"
    E0403 Error "value has the type of a record"
        "0020h–0023h describe whole objects; a value has one of the basic types. It is left out of the dictionary."
        "CiA 301, data types"
    W0404 Warning "AccessType is missing"
        "Every value says who may write it. `ro` is taken."
        "CiA 306-1, object sections"
    E0405 Error "AccessType is none"
        "AccessType is ro, wo, rw, rwr, rww or const. `ro` is taken."
        "CiA 306-1, object sections"
    W0406 Warning "PDOMapping is neither 0 nor 1"
        "0 is taken."
        "CiA 306-1, object sections"
    W0407 Warning "ObjFlags is no number"
        "0 is taken."
        "CiA 306-1, ObjFlags"
    I0408 Info "number with a leading 0 is octal"
        "`010` is 8. It is read so, as C reads it; not every reader does."
        "CiA 306-1, numbers"
    W0409 Warning "number with a leading 0 is not octal"
        "`08` is no octal number. It is read as decimal; many readers refuse it."
        "CiA 306-1, numbers"
    I0410 Info "two's complement for a negative number"
        "In a signed type a hexadecimal number may be the bit pattern: FFh is -1 in an INTEGER8. It is read so; not every reader does."
        "CiA 306-1, numbers"
    I0411 Info "$NODEID is not written as `$NODEID+n`"
        "Another order, other case or blanks are read the same; not every reader does."
        "CiA 306-1, $NODEID"
    E0412 Error "DefaultValue is no value of its type"
        "The value cannot be what the description says it is. The dictionary has no default there."
        "CiA 306-1, object sections; CiA 301, data types"
    E0413 Error "ParameterValue is no value of its type"
        "The value cannot be what the configuration says it is. The dictionary has the default there."
        "CiA 306-1, DCF; CiA 301, data types"
    E0414 Error "value is outside its limits"
        "A device refuses to be set to what its own default is."
        "CiA 306-1, LowLimit and HighLimit"
    E0415 Error "LowLimit is greater than HighLimit"
        "No value lies between them."
        "CiA 306-1, LowLimit and HighLimit"
    W0416 Warning "limit is no value of its type"
        "A limit that the type cannot reach limits nothing. It is left out of the dictionary."
        "CiA 306-1, LowLimit and HighLimit"
    E0417 Error "$NODEID where it cannot be"
        "Only an UNSIGNED8, UNSIGNED16, UNSIGNED24 or UNSIGNED32 can depend on the node ID."
        "CiA 306-1, $NODEID"
    E0418 Error "$NODEID formula does not fit its type for every node ID"
        "The sum with the highest node ID, 127, must fit."
        "CiA 306-1, $NODEID"
    W0419 Warning "byte string is not hexadecimal"
        "An OCTET_STRING or a DOMAIN is written as hexadecimal bytes. The characters are taken for the bytes."
        "CiA 306-1, object sections"
    W0420 Warning "number has a suffix or a decimal point"
        "`0x10L` and `5.0` are how other languages write integers. The integer is taken; many readers refuse it."
        "CiA 306-1, numbers"
    W0421 Warning "BOOLEAN is neither 0 nor 1"
        "`true` and `false` are words of other formats. They are read as 1 and 0."
        "CiA 306-1, object sections"

    // 05: PDOs
    E0501 Error "PDO maps an object that does not exist"
        "The PDO cannot be made."
        "CiA 301, PDO mapping parameter"
    E0502 Error "PDO maps an object that is not mappable"
        "PDOMapping=0 forbids it."
        "CiA 301, PDO mapping parameter"
    E0503 Error "PDO maps an object of the wrong direction"
        "A TPDO carries what can be read (ro, rw, rwr, const), an RPDO what can be written (wo, rw, rww)."
        "CiA 306-1, AccessType"
    E0504 Error "PDO maps an object with a wrong length"
        "The last byte of a mapping entry is the object's length in bits."
        "CiA 301, PDO mapping parameter"
    E0505 Error "PDO is longer than 64 bits"
        "A CAN frame carries eight bytes."
        "CiA 301, PDO mapping parameter"
    W0506 Warning "RPDO maps a dummy that [DummyUsage] does not allow"
        "A device says in [DummyUsage] which of the types 0001h–0007h fill gaps."
        "CiA 306-1, DummyUsage"
    E0507 Error "TPDO maps a dummy"
        "Dummies fill gaps in what is received; there is nothing to send."
        "CiA 301, dummy mapping"
    W0508 Warning "PDO has only one of its two objects"
        "A PDO has a communication and a mapping parameter, 200h apart."
        "CiA 301, PDO communication parameter"
    E0509 Error "PDO communication parameter lacks COB-ID or transmission type"
        "Sub-index 1 is the COB-ID, an UNSIGNED32, sub-index 2 the transmission type, an UNSIGNED8."
        "CiA 301, PDO communication parameter"
    E0510 Error "mapping entry is no UNSIGNED32"
        "A mapping entry is index, sub-index and length in one UNSIGNED32."
        "CiA 301, PDO mapping parameter"
    W0511 Warning "transmission type is reserved"
        "0–240 and 252–255 have a meaning, for an RPDO 0–240, 254 and 255."
        "CiA 301, PDO communication parameter"
    E0512 Error "PDO maps a sub-index that does not exist"
        "The PDO cannot be made."
        "CiA 301, PDO mapping parameter"
    W0513 Warning "PDO maps a BOOLEAN with 8 bits"
        "A BOOLEAN has one bit in a PDO. Some stacks send a byte, and a master that goes by the type reads the rest of the PDO wrong."
        "CiA 301, data types and PDO mapping parameter"
    W0514 Warning "CompactPDO is not written out"
        "CompactPDO stands for PDO objects that have no sections. odkit makes none: the device lacks them."
        "CiA 306-1, DeviceInfo"

    // 06: mandatory objects and identity
    E0601 Error "object 1000h is missing"
        "Every CANopen device has it; a master reads it first."
        "CiA 301, object 1000h"
    E0602 Error "object 1001h is missing"
        "Every CANopen device has it; emergency messages carry it."
        "CiA 301, object 1001h"
    E0603 Error "object 1018h is missing"
        "Every CANopen device has it; a master identifies the device by it."
        "CiA 301, object 1018h"
    E0604 Error "object 1000h is not as CiA 301 says"
        "A VAR, UNSIGNED32, read only."
        "CiA 301, object 1000h"
    E0605 Error "object 1001h is not as CiA 301 says"
        "A VAR, UNSIGNED8, read only."
        "CiA 301, object 1001h"
    E0606 Error "object 1018h is not as CiA 301 says"
        "A RECORD with UNSIGNED32 members, read only; sub-index 1, the vendor ID, is mandatory."
        "CiA 301, object 1018h"
    W0607 Warning "identity differs from [DeviceInfo]"
        "VendorNumber, ProductNumber and RevisionNumber are the defaults of 1018h; a master picks the EDS by them."
        "CiA 306-1, DeviceInfo"
    W0608 Warning "number of PDOs differs from [DeviceInfo]"
        "NrOfRxPDO and NrOfTxPDO count the PDOs of the device."
        "CiA 306-1, DeviceInfo"

    // 07: edits of a macro call or a variant
    E0701 Error "edit of what does not exist"
        "A variant is strict: it changes and removes what its base has."
        "odkit, object_dictionary!"
    E0702 Error "what is added exists already"
        "A variant is strict: it adds what its base lacks."
        "odkit, object_dictionary!"
    E0703 Error "added member has no object"
        "A member stands in an object; add the object first."
        "odkit, object_dictionary!"
    E0704 Error "object has no members"
        "Only a RECORD or an ARRAY has sub-indices."
        "odkit, object_dictionary!"
    E0705 Error "added object has no name"
        "The handle is called after the name."
        "odkit, object_dictionary!"
    E0706 Error "added value has no type"
        "A handle has a Rust type."
        "odkit, object_dictionary!"
    E0707 Error "value of an edit is none of its type"
        "A default or a limit is a value of the entry's type."
        "odkit, object_dictionary!"
    E0708 Error "value of the base is none of the new type"
        "An edit that changes the type says the values anew where they do not fit."
        "odkit, object_dictionary!"
    E0709 Error "member with an object code"
        "The code belongs to the object."
        "odkit, object_dictionary!"
    E0710 Error "value field of an object with members"
        "Type, access, default and limits belong to the members."
        "odkit, object_dictionary!"
}

#[cfg(test)]
mod tests;
