//! One line of JSON, for programs that start a bench.

use std::fmt::{self, Display, Write};

/// A JSON value.
#[derive(Clone, Debug)]
pub(super) enum Json {
    Null,
    Number(f64),
    Text(String),
    List(Vec<Json>),
    /// Keys in the order in which they are written.
    Object(Vec<(&'static str, Json)>),
}

impl From<&str> for Json {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Json {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<u64> for Json {
    fn from(number: u64) -> Self {
        Self::Number(number as f64)
    }
}

impl Display for Json {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Null => f.write_str("null"),
            Self::Number(number) => write!(f, "{number}"),
            Self::Text(text) => quoted(f, text),
            Self::List(list) => all(f, ('[', ']'), list, |f, value| write!(f, "{value}")),
            Self::Object(list) => all(f, ('{', '}'), list, |f, (key, value)| {
                quoted(f, key)?;
                write!(f, ":{value}")
            }),
        }
    }
}

fn all<T>(
    f: &mut fmt::Formatter<'_>,
    (open, close): (char, char),
    list: &[T],
    each: impl Fn(&mut fmt::Formatter<'_>, &T) -> fmt::Result,
) -> fmt::Result {
    f.write_char(open)?;
    for (at, one) in list.iter().enumerate() {
        if at > 0 {
            f.write_char(',')?;
        }
        each(f, one)?;
    }
    f.write_char(close)
}

fn quoted(f: &mut fmt::Formatter<'_>, text: &str) -> fmt::Result {
    f.write_char('"')?;
    for c in text.chars() {
        match c {
            '"' | '\\' => write!(f, "\\{c}")?,
            c if c < ' ' => write!(f, "\\u{:04x}", c as u32)?,
            c => f.write_char(c)?,
        }
    }
    f.write_char('"')
}

#[cfg(test)]
mod tests {
    use super::Json;

    #[test]
    fn json_is_one_line() {
        let json = Json::Object(vec![
            ("path", "a \"b\"\\\n".into()),
            (
                "list",
                Json::List(vec![5.into(), Json::Number(0.25), Json::Null]),
            ),
        ]);
        assert_eq!(
            json.to_string(),
            r#"{"path":"a \"b\"\\\u000a","list":[5,0.25,null]}"#
        );
    }
}
