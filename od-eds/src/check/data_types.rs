//! Every value has a type, and one that values can have.
//!
//! Guarantees that a value without a usable type was named. Assumes nothing; an
//! unknown DataType was named by the reader and stands in `extra`.
//! Source: CiA 306-1, object sections; CiA 301, data types.

use alloc::format;
use alloc::vec::Vec;

use super::place;
use crate::description::Description;
use crate::finding::Finding;
use crate::rules;
use od_model::{Address, Kind, ObjectCode};

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    for (index, object) in &description.objects {
        if matches!(
            *object.code,
            ObjectCode::Null | ObjectCode::DefType | ObjectCode::DefStruct
        ) {
            // Definitions have no value.
            continue;
        }
        for (sub, entry) in &object.entries {
            let address = Address::new(*index, *sub);
            match entry.data_type {
                None if entry
                    .extra
                    .iter()
                    .any(|(key, _)| key.eq_ignore_ascii_case("DataType")) => {}
                None => findings.push(
                    rules::E0401
                        .told(entry.span, "there is no DataType")
                        .about(address)
                        .with_help("write `DataType=` and the code of a type, for example `0x0007` for UNSIGNED32"),
                ),
                Some(data_type) if data_type.kind() == Kind::Record => findings.push(
                    rules::E0403
                        .told(
                            place(&[data_type.span, entry.span]),
                            format!("{} is the type of a whole object", data_type.name()),
                        )
                        .about(address)
                        .with_help("write the type of this one value, for example `DataType=0x0007` for UNSIGNED32"),
                ),
                Some(_) => {}
            }
        }
    }
}
