//! The odkit virtual encoder for JavaScript: a CAN bus with CANopen devices on it, in
//! virtual time.
//!
//! ```js
//! import init, { Bus } from 'od-playground';
//! await init();
//! const bus = new Bus();
//! bus.addDevice('gxmm', 1);
//! bus.advance(10_000, 100);                       // 10 ms pass
//! bus.send(0x601, new Uint8Array([0x40, 4, 0x60, 0, 0, 0, 0, 0]), false, false);
//! for (const frame of frames(bus.drain())) console.log(frame);
//! ```
//!
//! Only numbers, strings, byte arrays and plain records are passed; frames
//! are passed packed, many at once. Nothing here reads a clock: time passes when
//! [`Bus::advance`] is called.

#![deny(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[cfg(feature = "direct")]
mod bench;
mod bus;
mod codec;
#[cfg(feature = "eds")]
mod configured;
mod crossing;
#[cfg(feature = "logs")]
mod dbc;
mod device;
mod diagnostics;
#[cfg(feature = "direct")]
mod direct;
#[cfg(feature = "editor")]
mod editor;
#[cfg(feature = "eds")]
mod eds;
#[cfg(feature = "lessons")]
mod faults;
mod frames;
mod journal;
#[cfg(feature = "lessons")]
mod labs;
#[cfg(test)]
mod layout;
#[cfg(feature = "lessons")]
mod lesson;
#[cfg(feature = "logs")]
mod logs;
mod objects;
mod packed;
#[cfg(feature = "pins")]
mod pins;
mod places;
#[cfg(feature = "real")]
mod plain;
#[cfg(feature = "real")]
mod real;
mod record;
mod sdo;
mod signals;
mod statistics;
mod status;
mod templates;
mod values;

pub use bus::Bus;
pub use codec::{
    Transfers, decode_value, encode_value, frame_bits, read_line, tag_names, tags, type_range,
};
#[cfg(feature = "logs")]
pub use dbc::{dbc_words, read_dbc};
pub use device::builtin_devices;
#[cfg(feature = "editor")]
pub use editor::{LanguageServer, compare_eds, device_eds, encode_eds, rule_titles};
#[cfg(feature = "eds")]
pub use eds::{check_eds, decode_eds, fix_eds, foreign_file};
#[cfg(feature = "lessons")]
pub use faults::{case_row, fault_cases, judge_case, open_case, try_probe};
pub use journal::{check_run, read_input};
#[cfg(feature = "lessons")]
pub use lesson::{judge_answer, parse_lesson, translate_lesson};
#[cfg(feature = "logs")]
pub use logs::{diagnose, read_log, write_log};
#[cfg(feature = "real")]
pub use plain::plain_eds;
#[cfg(feature = "real")]
pub use real::{Adapter, identify};
pub use signals::{mapped_values, read_values};
pub use statistics::Statistics;
pub use templates::frame_templates;
