//! Signals of a DBC file beside the frames.

use std::cell::RefCell;

use od_sim::dbc::Database;
use wasm_bindgen::prelude::*;

use crate::packed;

thread_local! {
    /// The file that was read last, with its content: a page asks for the same file again and again.
    static LAST: RefCell<Option<(Vec<u8>, Database)>> = const { RefCell::new(None) };
}

fn with<R>(file: &[u8], act: impl FnOnce(&Database) -> R) -> Result<R, JsError> {
    LAST.with_borrow_mut(|last| {
        if last.as_ref().is_none_or(|(known, _)| known != file) {
            *last = Some((file.to_vec(), Database::read(file)?));
        }
        let database = last.as_ref().map(|(_, database)| act(database));
        database.ok_or_else(|| JsError::new("the file was not read"))
    })
}

/// Reads a DBC file; returns the number of its messages, and of its signals that no classic frame can hold.
///
/// # Errors
/// The reason why it is not a DBC file, with the line.
#[wasm_bindgen(js_name = readDbc)]
pub fn read_dbc(file: &[u8]) -> Result<Vec<usize>, JsError> {
    with(file, |database| vec![database.len(), database.left_out()])
}

/// The message and the signals of each of these packed frames in words; empty for a frame that the DBC file does not
/// describe.
///
/// # Errors
/// As `readDbc`.
#[wasm_bindgen(js_name = dbcWords)]
pub fn dbc_words(file: &[u8], frames: &[u8]) -> Result<Vec<String>, JsError> {
    with(file, |database| {
        let words = |one: &[u8]| {
            let frame = packed::frame(one).filter(|_| !packed::is_disturbed(one));
            frame
                .and_then(|frame| database.words(&frame))
                .unwrap_or_default()
        };
        frames.chunks_exact(packed::LEN).map(words).collect()
    })
}
