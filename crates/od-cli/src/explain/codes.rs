//! Abort codes and EMCY error codes, as people copy them: `0x06070010`, `06020000h`, `16#05040000`, `8130h`.

use od_wire::{AbortCode, AbortReason, emcy};

/// The digits of a hexadecimal number: one to four for an EMCY error code, up to eight for an abort code.
fn digits(word: &str) -> Option<String> {
    let word: String = word.split([' ', '_']).collect();
    let word = word.to_ascii_lowercase();
    let starts = ["0x", "16#"].into_iter();
    let start = starts.filter_map(|start| word.strip_prefix(start)).next();
    let rest = start.unwrap_or(&word);
    let ends = ["hex", "h"].into_iter();
    let end = ends.filter_map(|end| rest.strip_suffix(end)).next();
    let digits = end.unwrap_or(rest);
    let is_one = (1..=8).contains(&digits.len()) && digits.bytes().all(|c| c.is_ascii_hexdigit());
    is_one.then(|| digits.to_owned())
}

/// Explains an abort code or an EMCY error code; `None` if the word is neither.
pub(super) fn page(word: &str) -> Option<String> {
    let digits = digits(word)?;
    let number = u32::from_str_radix(&digits, 16).ok()?;
    match u16::try_from(number) {
        Ok(code) if number > 0 || digits.len() <= 4 => Some(error(code)),
        _ => abort(number),
    }
}

fn abort(number: u32) -> Option<String> {
    // CiA 301, table 22: the first byte is the class of the error.
    if !matches!(number >> 24, 0x05 | 0x06 | 0x08) {
        return None;
    }
    let code = AbortCode::from_code(number);
    let mut text = format!("{} (SDO abort code)\n", AbortReason(number));
    let check = code.and_then(check);
    let check = check.unwrap_or("the manual of the device, which may define the code");
    text.push_str(&format!("\nCheck:  {check}\n"));
    if code.is_some() {
        text.push_str("Source: CiA 301, 7.2.4.3.17, table 22\n");
    }
    Some(text)
}

/// The place to look at first.
fn check(code: AbortCode) -> Option<&'static str> {
    Some(match code {
        AbortCode::ToggleBit => {
            "whether a segment was lost or sent twice, and whether two clients use the channel"
        }
        AbortCode::Timeout => {
            "power, node ID and bit rate of the node; whether it is in Stopped; 1200h; the time-out of the client"
        }
        AbortCode::InvalidCommand => {
            "whether the server supports block transfer; whether the client sends a segment without a transfer"
        }
        AbortCode::InvalidBlockSize => "the block size of the client: 1 to 127 segments",
        AbortCode::InvalidSequence => "frames that were lost or overtook each other in a block",
        AbortCode::Crc => {
            "whether both sides compute the CRC of CiA 301, over the data without the filling bytes"
        }
        AbortCode::OutOfMemory => "the size of the value against the manual of the device",
        AbortCode::UnsupportedAccess => {
            "the access type in the EDS; the order of the writes: the PDO is not valid (bit 31), then sub-index 0 of the mapping is 0"
        }
        AbortCode::WriteOnly => "the access type in the EDS: the object cannot be read",
        AbortCode::ReadOnly => {
            "the access type in the EDS; the object may be fixed while a PDO is valid or a drive is enabled"
        }
        AbortCode::SubZeroFirst => {
            "the order of the writes: 0 to sub-index 0, then the other sub-indices, then the number"
        }
        AbortCode::NoObject => "the index, and whether the EDS is that of this device and firmware",
        AbortCode::NotMappable => "PDOMapping and AccessType of the object in the EDS",
        AbortCode::PdoTooLong => "the lengths in the mapping: a PDO has 64 bits",
        AbortCode::Incompatible | AbortCode::DeviceIncompatible => {
            "the other objects of the same function, such as mapping and transmission type, or mode and value"
        }
        AbortCode::Hardware => {
            "the memory or the hardware behind the object; repeat the access after a power cycle"
        }
        AbortCode::Length | AbortCode::TooLong | AbortCode::TooShort => {
            "DataType in the EDS against the number of bytes that the client sends"
        }
        AbortCode::NoSubIndex => "the sub-index against sub-index 0 of the object, and the EDS",
        AbortCode::ValueRange | AbortCode::ValueTooHigh | AbortCode::ValueTooLow => {
            "the value against LowLimit and HighLimit in the EDS, and against the manual"
        }
        AbortCode::MaximumBelowMinimum => "the order of the writes to the two limits",
        AbortCode::NoResource => "SDO connections and PDOs of the device that are already in use",
        AbortCode::General => "the error history 1003h and the manual of the device",
        AbortCode::NotStored => {
            "1010h and 1011h: the signature, `save` or `load`; other objects: the manual of the device"
        }
        AbortCode::LocalControl => {
            "a switch or a program of the device that controls the object, such as local operation"
        }
        AbortCode::DeviceState => {
            "the NMT state and the state of the drive: many objects change only in Pre-operational, or while the drive is disabled"
        }
        AbortCode::NoDictionary => "the files from which the device makes its dictionary",
        AbortCode::NoData => "whether the object has a value already, such as an entry of 1003h",
        _ => return None,
    })
}

/// Bits of the error register (CiA 301, 7.5.2.2).
const REGISTER: [&str; 8] = [
    "generic error",
    "current",
    "voltage",
    "temperature",
    "communication",
    "device profile",
    "reserved",
    "manufacturer-specific",
];

fn error(code: u16) -> String {
    let (general, drive) = (emcy::text(None, code), emcy::text(Some(402), code));
    let mut text = format!("{code:04X}h {general} (EMCY error code)\n\n");
    if drive != general {
        text.push_str(&format!("Drive:  {drive} (CiA 402)\n"));
    }
    let bits = emcy::register(code);
    if code != 0 {
        let set = REGISTER.iter().enumerate();
        let set = set.filter(|(bit, _)| bits >> bit & 1 == 1);
        let names: Vec<&str> = set.map(|(_, name)| *name).collect();
        text.push_str(&format!(
            "1001h:  {bits:02X}h, {}\nCheck:  1003h of the node, and its manual, which may say more\n",
            names.join(" and ")
        ));
    }
    text.push_str("Source: CiA 301, 7.2.7.1, table 26\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_is_known_as_people_copy_it() {
        let short = [
            (
                "0x06070010",
                "06070010h length does not match the data type (SDO abort code)",
            ),
            (
                "06020000h",
                "06020000h object does not exist (SDO abort code)",
            ),
            (
                "16#05040000",
                "05040000h SDO transfer timed out (SDO abort code)",
            ),
            (
                "0503 0000 hex",
                "05030000h toggle bit did not alternate (SDO abort code)",
            ),
            (
                "5040001",
                "05040001h command specifier unknown or out of turn (SDO abort code)",
            ),
            (
                "8130",
                "8130h life guard or heartbeat error (EMCY error code)",
            ),
            ("0x00008220", "8220h PDO too long (EMCY error code)"),
            ("FF10H", "FF10h device-specific (EMCY error code)"),
            ("0", "0000h no error, or error reset (EMCY error code)"),
        ];
        for (word, first) in short {
            let page = page(word).unwrap_or_default();
            assert_eq!(page.lines().next(), Some(first), "{word}");
        }
        for word in [
            "",
            "h",
            "0x",
            "EMCY",
            "E04123",
            "123456789",
            "12345678",
            "07000000",
            "0x-1",
        ] {
            assert_eq!(page(word), None, "{word}");
        }
    }

    #[test]
    fn each_abort_code_says_what_to_check() {
        for code in AbortCode::ALL {
            assert!(check(*code).is_some(), "{code}");
            let page = page(&format!("{:08X}", code.code())).expect("a page");
            assert!(
                page.lines().all(|line| line.chars().count() <= 140),
                "{page}"
            );
        }
        assert!(
            page("08040001")
                .expect("a page")
                .contains("the manual of the device")
        );
    }

    #[test]
    fn a_code_of_a_drive_has_both_meanings() {
        let page = page("2310h").expect("a page");
        assert!(page.contains("Drive:  continuous over-current"), "{page}");
        assert!(
            page.contains("1001h:  03h, generic error and current\n"),
            "{page}"
        );
    }
}
