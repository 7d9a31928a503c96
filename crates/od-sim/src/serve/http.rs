//! Detects a browser by the first bytes of a client, to refuse it.

/// Longest method of a request.
const LONGEST: usize = 32;

/// Any web page can make a browser connect to a port of this computer and send lines in the body
/// of a `POST`. This looks at the first bytes of a client for that.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Opening {
    letters: usize,
    is_over: bool,
    /// Only a word in capitals is an HTTP method: the client sends words, too.
    capitals: bool,
}

impl Opening {
    /// For a client that sends lines of the script language.
    pub(super) fn of_lines() -> Self {
        Self {
            capitals: true,
            ..Self::default()
        }
    }

    /// Takes the next bytes, and returns whether they begin an HTTP request: a word and a blank. No
    /// command of slcan has a blank, and those of socketcand begin with `<`.
    pub(super) fn is_http(&mut self, bytes: &[u8]) -> bool {
        for byte in bytes {
            match byte {
                _ if self.is_over => return false,
                b'\r' | b'\n' if self.letters == 0 => {}
                b' ' if self.letters > 0 => return true,
                b'a'..=b'z' if self.capitals => self.is_over = true,
                b'A'..=b'Z' | b'a'..=b'z' | b'-' | b'_' if self.letters < LONGEST => {
                    self.letters += 1;
                }
                _ => self.is_over = true,
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::Opening;

    #[test]
    fn a_verb_of_the_script_language_is_no_method() {
        for (text, is_http) in [
            ("POST / HTTP/1.1", true),
            ("power off", false),
            ("can0 601#40", false),
            ("701#R", false),
        ] {
            assert_eq!(
                Opening::of_lines().is_http(text.as_bytes()),
                is_http,
                "{text}"
            );
        }
    }

    #[test]
    fn a_request_is_detected_however_it_is_split() {
        for (text, is_http) in [
            ("POST / HTTP/1.1\r\nHost: a\r\n\r\nO\r", true),
            ("GET / HTTP/1.1", true),
            ("OPTIONS * HTTP/1.1", true),
            ("PRI * HTTP/2.0", true),
            ("M-SEARCH * HTTP/1.1", true),
            ("\r\nget / HTTP/1.1", true),
            ("C\rS6\rO\r", false),
            ("\r\r\rC\r POST / HTTP/1.1", false),
            ("t1230\r", false),
            ("< open can0 >", false),
            (" POST", false),
            ("", false),
        ] {
            assert_eq!(
                Opening::default().is_http(text.as_bytes()),
                is_http,
                "{text}"
            );
            let mut opening = Opening::default();
            let mut pieces = text.as_bytes().chunks(1);
            assert_eq!(
                pieces.any(|piece| opening.is_http(piece)),
                is_http,
                "{text}"
            );
        }
    }
}
