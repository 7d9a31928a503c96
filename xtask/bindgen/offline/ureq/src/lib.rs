//! The items of `ureq` that wasm-pack imports. Every request fails.

use std::fmt;
use std::io;

/// Makes an [`Agent`].
pub fn builder() -> AgentBuilder {
    AgentBuilder
}

/// Settings, which have no effect.
pub struct AgentBuilder;

impl AgentBuilder {
    pub fn try_proxy_from_env(self, _: bool) -> Self {
        self
    }

    pub fn user_agent(self, _: &str) -> Self {
        self
    }

    pub fn build(self) -> Agent {
        Agent
    }
}

/// Makes a [`Request`].
pub struct Agent;

impl Agent {
    pub fn get(&self, url: &str) -> Request {
        Request(String::from(url))
    }
}

/// A request for an address.
pub struct Request(String);

impl Request {
    pub fn set(self, _: &str, _: &str) -> Self {
        self
    }

    /// Fails.
    pub fn call(self) -> Result<Response, Error> {
        Err(Error(self.0))
    }
}

/// A response. No request gets one.
pub enum Response {}

impl Response {
    pub fn status(&self) -> u16 {
        match *self {}
    }

    pub fn into_json<T>(self) -> io::Result<T> {
        match self {}
    }
}

/// Names the address of the request that was not sent.
#[derive(Debug)]
pub struct Error(String);

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "this wasm-pack does not use the network: {}", self.0)
    }
}

impl std::error::Error for Error {}
