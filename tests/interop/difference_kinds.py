"""The kinds of differences between odkit's reading and python-canopen's: who is right, and why."""

# Kind: which side is right, and why.
KINDS = {
    "file: text that is not UTF-8": (
        "odkit", "python-canopen opens every file as UTF-8; the vendor wrote Windows-1252."),
    "file: a line, section or key that stops the INI reader": (
        "odkit", "One invalid line should not stop the reader; odkit reports it and reads the rest."),
    "file: [DummyUsage] or [Comments] lacks a key": (
        "odkit", "A missing dummy is not allowed, and comments do not describe the device; odkit reads the objects."),
    "file: a number is empty or followed by a comment": (
        "odkit", "An empty field says nothing, and `# VAR` is a comment; python-canopen gives up the file."),
    "file: DataType, AccessType or ParameterName is missing": (
        "odkit", "The value is named as faulty; all others are as good as ever."),
    "file: [xxxxName] names some members only": (
        "odkit", "CiA 306-1: [xxxxName] lists the members whose name differs; python-canopen expects all of them."),
    "file: member of an object without its section": (
        "odkit", "The member is kept; python-canopen gives up the file."),
    "object: dummies": (
        "odkit", "python-canopen makes objects 0001h-0007h of [DummyUsage]; the file describes none."),
    "object: made from CompactPDO": (
        "odkit", "CiA 306-1: CompactPDO replaces the sections of PDO objects; python-canopen does not know it."),
    "object: DEFTYPE, DEFSTRUCT or NULL": (
        "odkit", "CiA 301 has more object codes than VAR, DOMAIN, ARRAY and RECORD; python-canopen drops the object."),
    "object: VAR with members": (
        "odkit", "The file calls a record a VAR; python-canopen drops the members, odkit says so and keeps them."),
    "object: member with a subsection name that python-canopen does not match": (
        "odkit", "INI names are the same in any case, with or without zeros in front."),
    "object: members of CompactSubObj": (
        "odkit", "CiA 306-1: sub-index 0 and each member exist; python-canopen makes them on demand or not at all."),
    "object: ARRAY members that the file does not have": (
        "odkit", "python-canopen makes up members up to FFh from sub-index 1."),
    "name: `;` in a name": (
        "odkit", "A comment has a line of its own (CiA 306-1); python-canopen cuts the name at ` ;`."),
    "name: member of CompactSubObj": (
        "odkit", "CiA 306-1: the name is ParameterName with the sub-index after it; python-canopen writes `_`."),
    "name: NrOfObjects": (
        "odkit", "CiA 306-1 gives sub-index 0 of CompactSubObj this name."),
    "type: not a basic type": (
        "neither", "The type of a record or of no one: python-canopen calls it DOMAIN, odkit leaves it open and says so."),
    "access: of sub-index 0 of CompactSubObj": (
        "odkit", "CiA 306-1: `ro`; python-canopen leaves its own default, `rw`."),
    "access: none that CiA 306 knows": (
        "neither", "python-canopen keeps the word as text, odkit takes `ro` and reports an error."),
    "access: followed by a comment": (
        "odkit", "`rw;` is rw; python-canopen keeps the semicolon."),
    "mapping: a flag that is neither 0 nor 1": (
        "neither", "python-canopen takes any number for yes, odkit takes no and warns."),
    "value: sub-index 0 of CompactSubObj": (
        "odkit", "CiA 306-1: its value is CompactSubObj; python-canopen has none."),
    "value: from [xxxxValue]": (
        "odkit", "CiA 306-1: the section gives members of CompactSubObj their values; python-canopen does not read it."),
    "value: an empty text": (
        "odkit", "`DefaultValue=` gives no value; python-canopen takes a text of no characters."),
    "value: octal": (
        "odkit", "CiA 306-1: a leading 0 is octal; Python refuses `010`, and python-canopen drops the value silently."),
    "value: leading zeros": (
        "odkit", "`08` can only be decimal; python-canopen drops the value silently."),
    "value: two's complement": (
        "odkit", "0xFF is -1 in an INTEGER8: the bits a master sees; python-canopen keeps 255, which the type cannot hold."),
    "value: out of the range of its type": (
        "odkit", "No such value can be sent. odkit leaves it out of the dictionary with an error; python-canopen keeps it."),
    "value: integer with a suffix, a point or `true`": (
        "odkit", "C's `0x10L` and `5.0` mean integers; python-canopen drops the value silently."),
    "value: followed by a comment": (
        "odkit", "The number in front of `#` or `;` is meant; python-canopen drops the value silently."),
    "value: `;` in a text": (
        "odkit", "A comment has a line of its own (CiA 306-1); python-canopen cuts the text at ` ;`."),
    "value: OCTET_STRING or DOMAIN in another form": (
        "odkit", "`0x1234`, single digits or plain characters; python-canopen knows digit pairs and drops the rest silently."),
    "value: UNICODE_STRING": (
        "both", "odkit keeps the bytes that the bus sees (UTF-16, low byte first), python-canopen the text."),
    "value: time": (
        "odkit", "Days and milliseconds, as Lely writes them; python-canopen reads the digits of both as one number."),
    "value: real with a comma": (
        "odkit", "`1,5` is 1.5, as German tools write it; python-canopen drops the value silently."),
    "value: real in hexadecimal or with a suffix": (
        "odkit", "0x40490FDB is the bit pattern of a REAL32, `1.0f` is 1; python-canopen drops the value silently."),
    "value: $NODEID in another case or place": (
        "odkit", "python-canopen knows `$NODEID` in capitals next to one `+`."),
    "value: no value at all": (
        "both", "Neither makes a number of it; odkit says so."),
    "value: of an unknown type": (
        "neither", "Without a type the value cannot be read; python-canopen reads bytes or numbers as they come."),
    "limit: of a real": (
        "odkit", "python-canopen reads limits as integers only and drops these silently."),
    "limit: of a text or bytes": (
        "odkit", "A text has no limits; python-canopen keeps the number."),
    "limit: of a 24-, 40-, 48- or 56-bit integer": (
        "odkit", "python-canopen knows the bits of four signed types and drops other limits silently."),
    "limit: beyond the type, in decimal": (
        "odkit", "65535 is not a valid INTEGER16. python-canopen makes it -1, which turns an upper limit into a lower one; "
        "odkit leaves it out and warns. In hexadecimal it is a bit pattern, and both agree."),
    "limit: high limit that is a bit pattern below the low one": (
        "odkit", "Between 0 and 0xFF of an INTEGER8, 0xFF is not -1: the limit is not a valid value of the type."),
    "limit: $NODEID": (
        "odkit", "A limit may depend on the node ID as a default may; python-canopen drops it silently."),
    "limit: of an object with members": (
        "odkit", "The limits of CompactSubObj are those of its members, not of sub-index 0."),
}
