//! The frames of the Language Server Protocol: headers, an empty line, and a text of the given length.

use std::io::{self, BufRead, Read};

/// Longest line of a header, in bytes.
const LINE: u64 = 4096;
/// Longest text, in bytes: a file of 100 MB with every character escaped.
const TEXT: u64 = 256 << 20;

/// A message from the input, or the end of the input.
#[derive(PartialEq, Eq, Debug)]
pub(super) enum Frame {
    /// A text.
    Message(String),
    /// Not a valid frame; the next one may be valid.
    Broken(String),
    /// The input has ended.
    End,
}

/// Reads a frame.
///
/// # Errors
/// The input cannot be read.
pub(super) fn read(input: &mut impl BufRead) -> io::Result<Frame> {
    let mut length = None;
    let mut wrong = None;
    let mut line = Vec::new();
    loop {
        line.clear();
        input.by_ref().take(LINE).read_until(b'\n', &mut line)?;
        if line.is_empty() {
            return Ok(Frame::End);
        }
        if !line.ends_with(b"\n") && line.len() as u64 == LINE {
            input.skip_until(b'\n')?;
            wrong = Some("a header line is too long".to_owned());
            continue;
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim();
        if text.is_empty() {
            break;
        }
        let header = text.split_once(':');
        let value = header.filter(|(name, _)| name.trim().eq_ignore_ascii_case("Content-Length"));
        match value.map(|(_, value)| value.trim().parse::<u64>()) {
            Some(Ok(given)) => length = Some(given),
            Some(Err(_)) => wrong = Some(format!("`{text}` is not a length")),
            None => {}
        }
    }
    let Some(length) = length else {
        let why = wrong.unwrap_or_else(|| "the header Content-Length is missing".into());
        return Ok(Frame::Broken(why));
    };
    let mut body = input.take(length);
    if length > TEXT {
        io::copy(&mut body, &mut io::sink())?;
        return Ok(Frame::Broken(format!(
            "a message of {length} bytes is too long"
        )));
    }
    let mut bytes = Vec::new();
    body.read_to_end(&mut bytes)?;
    if (bytes.len() as u64) < length {
        return Ok(Frame::End);
    }
    Ok(match String::from_utf8(bytes) {
        Ok(text) => Frame::Message(text),
        Err(_) => Frame::Broken("the message is not valid UTF-8".into()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_read_in_order_between_other_bytes() {
        let long = format!("X: {}\r\nContent-Length: 1\r\n\r\nc", "x".repeat(9000));
        let input = [
            "Content-Length: 2\r\n\r\n{}",
            "content-length:1\nContent-Type: x\n\na",
            "Content-Length: many\r\n\r\n",
            "nothing\r\n\r\n",
            "Content-Length: 99999999999999999999\r\n\r\n",
            "Content-Length: 0\r\n\r\n",
            &long,
            "Content-Length: 7\r\n\r\ncut",
        ];
        let input = [input.concat().as_bytes(), b"\xFF"].concat();
        let mut input = &input[..];
        let mut read = || read(&mut input).unwrap();
        let message = |text: &str| Frame::Message(text.into());
        assert_eq!(read(), message("{}"));
        assert_eq!(read(), message("a"));
        for _ in 0..3 {
            assert!(matches!(read(), Frame::Broken(_)));
        }
        assert_eq!(read(), message(""));
        assert_eq!(read(), message("c"));
        assert_eq!(read(), Frame::End);
    }

    #[test]
    fn a_length_that_is_too_large_is_refused() {
        let mut input = &b"Content-Length: 18446744073709551615\r\n\r\nabc"[..];
        assert!(matches!(read(&mut input).unwrap(), Frame::Broken(_)));
        assert_eq!(read(&mut input).unwrap(), Frame::End);
        let mut input = &b"Content-Length: 1\r\n\r\n\xFF"[..];
        assert!(matches!(read(&mut input).unwrap(), Frame::Broken(_)));
    }
}
