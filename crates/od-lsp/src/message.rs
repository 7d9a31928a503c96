//! Messages of JSON-RPC 2.0 in the form of the Language Server Protocol: one text each.

use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A message of the client.
#[derive(Deserialize)]
pub(crate) struct Incoming {
    /// Missing in a notification.
    #[serde(default)]
    pub(crate) id: Option<Value>,
    /// Missing in a response.
    #[serde(default)]
    pub(crate) method: Option<String>,
    #[serde(default)]
    pub(crate) params: Value,
}

impl Incoming {
    /// Reads a message.
    ///
    /// # Errors
    /// The text is not JSON, or not an object with a method or an id.
    pub(crate) fn read(text: &str) -> Result<Self, Fault> {
        let incoming: Result<Self, _> = serde_json::from_str(text);
        // serde would read an array as the fields of a message.
        let is_object = text.trim_start().starts_with('{');
        match incoming {
            Ok(incoming) if is_object && (incoming.method.is_some() || incoming.id.is_some()) => {
                Ok(incoming)
            }
            Ok(_) => Err(Fault::invalid("not a message: it has no method and no id")),
            Err(error) => Err(match serde_json::from_str::<IgnoredAny>(text) {
                Ok(_) => Fault::invalid(format!("not a message: {error}")),
                Err(_) => Fault::parse(format!("not JSON: {error}")),
            }),
        }
    }
}

/// Reason why a request has no result.
#[derive(Serialize, Debug)]
pub(crate) struct Fault {
    code: i32,
    message: String,
}

impl Fault {
    const fn new(code: i32, message: String) -> Self {
        Self { code, message }
    }

    /// The text is not JSON.
    pub(crate) fn parse(message: impl Into<String>) -> Self {
        Self::new(-32700, message.into())
    }

    /// It is JSON, but no valid message at this time.
    pub(crate) fn invalid(message: impl Into<String>) -> Self {
        Self::new(-32600, message.into())
    }

    pub(crate) fn unknown(method: &str) -> Self {
        Self::new(-32601, format!("method `{method}` is not supported"))
    }

    pub(crate) fn params(error: &serde_json::Error) -> Self {
        Self::new(-32602, format!("invalid parameters: {error}"))
    }

    pub(crate) fn not_initialized() -> Self {
        Self::new(-32002, "send `initialize` first".into())
    }

    pub(crate) fn cancelled() -> Self {
        Self::new(-32800, "the request was cancelled".into())
    }

    /// The request is valid but impossible for this text.
    pub(crate) fn failed(message: impl Into<String>) -> Self {
        Self::new(-32803, message.into())
    }
}

#[derive(Serialize)]
struct Answer<'a, T> {
    jsonrpc: &'static str,
    id: &'a Value,
    result: &'a T,
}

#[derive(Serialize)]
struct Refusal<'a> {
    jsonrpc: &'static str,
    id: &'a Value,
    error: &'a Fault,
}

#[derive(Serialize)]
struct Call<'a, T> {
    jsonrpc: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    id: Option<&'a str>,
    method: &'a str,
    params: &'a T,
}

/// This cannot fail: the types of this crate have only text keys.
fn written(message: &impl Serialize) -> String {
    serde_json::to_string(message).unwrap_or_default()
}

/// A response with a result.
pub(crate) fn answer(id: &Value, result: &impl Serialize) -> String {
    written(&Answer {
        jsonrpc: "2.0",
        id,
        result,
    })
}

/// A response with an error; the id of an unreadable message is null.
pub(crate) fn refusal(id: &Value, error: &Fault) -> String {
    written(&Refusal {
        jsonrpc: "2.0",
        id,
        error,
    })
}

pub(crate) fn notification(method: &str, params: &impl Serialize) -> String {
    written(&Call {
        jsonrpc: "2.0",
        id: None,
        method,
        params,
    })
}

/// A request to the client.
pub(crate) fn request(id: &str, method: &str, params: &impl Serialize) -> String {
    written(&Call {
        jsonrpc: "2.0",
        id: Some(id),
        method,
        params,
    })
}
