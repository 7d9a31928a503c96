//! Prints the values that canopen-rs reads from files: their names come on standard input, their folder is the argument.

use canopen_host::eds::Eds;
use canopen_rs::datatypes::{DataType, Value};
use canopen_rs::object_dictionary::AccessType;

fn main() {
    let folder = std::env::args().nth(1).expect("a folder");
    for name in std::io::stdin().lines() {
        let name = name.expect("a name");
        let eds = match Eds::from_file(format!("{folder}/{name}")) {
            Ok(eds) => eds,
            Err(error) => {
                println!("{name}\terror\t{}", error.to_string().escape_default());
                continue;
            }
        };
        println!("{name}\tread");
        for object in &eds.objects {
            let address = object.address;
            let data_type = code(object.data_type);
            let access = match object.access {
                AccessType::Ro => "ro",
                AccessType::Wo => "wo",
                AccessType::Rw => "-",
                AccessType::Const => "const",
            };
            let mapping = u8::from(object.pdo_mappable);
            let value = shown(&object.default_value);
            let name = object.parameter_name.escape_default();
            println!(
                "\t{:04X}\t{:X}\t{data_type}\t{access}\t{mapping}\t{value}\t-\t-\t{value}\tt{name}",
                address.index, address.subindex
            );
        }
    }
}

fn code(data_type: DataType) -> u16 {
    match data_type {
        DataType::Boolean => 1,
        DataType::Integer8 => 2,
        DataType::Integer16 => 3,
        DataType::Integer32 => 4,
        DataType::Unsigned8 => 5,
        DataType::Unsigned16 => 6,
        DataType::Unsigned32 => 7,
        DataType::Real32 => 8,
        DataType::VisibleString => 9,
        DataType::OctetString => 10,
        DataType::Domain => 15,
        DataType::Real64 => 17,
        DataType::Integer64 => 21,
        DataType::Unsigned64 => 27,
        _ => 0,
    }
}

fn shown(value: &Value) -> String {
    let bytes = |bytes: &[u8]| bytes.iter().fold("b".into(), |out, byte| format!("{out}{byte:02x}"));
    match value {
        Value::Boolean(value) => format!("i{}", u8::from(*value)),
        Value::Integer8(value) => format!("i{value}"),
        Value::Integer16(value) => format!("i{value}"),
        Value::Integer32(value) => format!("i{value}"),
        Value::Integer64(value) => format!("i{value}"),
        Value::Unsigned8(value) => format!("i{value}"),
        Value::Unsigned16(value) => format!("i{value}"),
        Value::Unsigned32(value) => format!("i{value}"),
        Value::Unsigned64(value) => format!("i{value}"),
        Value::Real32(value) => format!("r{:?}", f64::from(*value)),
        Value::Real64(value) => format!("r{value:?}"),
        Value::VisibleString(text) => {
            format!("t{}", String::from_utf8_lossy(text.as_bytes()).escape_default())
        }
        Value::OctetString(text) | Value::Domain(text) => bytes(text.as_bytes()),
        _ => "-".into(),
    }
}
