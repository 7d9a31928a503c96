//! A WebSocket server for pages.

use super::opened::{Opened, Protocol};
use super::tcp;
use crate::links::address;
use crate::links::web_socket::Gate;
use crate::serve::error::Error;
use od_model::Refused;

/// Shortest token that a user may choose, in characters.
const SHORTEST: usize = 16;

/// Reads `HOST:PORT[?token=TOKEN]` into a place and a token.
///
/// # Errors
/// The address or the token is invalid.
pub(super) fn parse(place: &str) -> Result<(String, Option<String>), Refused> {
    let (place, query) = match place.split_once('?') {
        Some((place, query)) => (place, Some(query)),
        None => (place, None),
    };
    let token = match query {
        Some(query) => Some(token(query)?),
        None => None,
    };
    Ok((address::tcp(place)?, token))
}

fn token(query: &str) -> Result<String, String> {
    let given = query.strip_prefix("token=").unwrap_or_default();
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'-' | b'_');
    if given.len() >= SHORTEST && given.bytes().all(is_plain) {
        Ok(given.to_owned())
    } else {
        Err(format!(
            "`?{query}` is not a token; write `?token=` and at least {SHORTEST} letters, digits, - or _, or \
             leave it out for a random one"
        ))
    }
}

/// Reads the origin of a page.
///
/// # Errors
/// The text is not an origin.
pub(in crate::serve) fn origin(text: &str) -> Result<String, String> {
    let place = text.strip_prefix("https://");
    let place = place.or_else(|| text.strip_prefix("http://"));
    match place.filter(|it| !it.is_empty() && !it.contains(['/', '?', '#', '@', ' '])) {
        Some(_) => Ok(text.to_ascii_lowercase()),
        None => {
            Err("write the beginning of the page's address, such as https://example.org".into())
        }
    }
}

/// Listens at `HOST:PORT`; without a `token` it makes a random one.
pub(super) fn listen(
    place: &str,
    token: Option<&str>,
    origins: &[String],
) -> Result<Opened, Error> {
    let token = match token {
        Some(token) => token.to_owned(),
        None => random()?,
    };
    // Links live as long as the program, one value for each.
    let gate = Box::leak(Box::new(Gate::new(token, origins.to_vec())));
    tcp::listen(Protocol::WebSocket(gate), place)
}

fn random() -> Result<String, Error> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes)
        .map_err(|error| Error::Failed(format!("no random token: {error}; give ?token=")))?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}
