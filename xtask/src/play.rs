//! `cargo xtask play`: from a fresh clone to the page in the browser.

use std::time::Instant;

use crate::bundle;
use crate::console::{Console, say, seconds};
use crate::error::{Error, Result};
use crate::repo::Repo;
use crate::serve::{self, Server};

/// The command line of `play`.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Options {
    port: Option<u16>,
    serve: bool,
    small: bool,
}

impl Options {
    /// Reads the arguments after `play`.
    pub(crate) fn parse(args: &[String]) -> Result<Options> {
        let (mut port, mut serve, mut small) = (None, true, false);
        // `--port=9000` is `--port 9000`.
        let mut words = args.iter().flat_map(|arg| arg.split('='));
        while let Some(word) = words.next() {
            match word {
                "--port" => {
                    let number = words.next().and_then(|text| text.parse().ok());
                    let wrong = "--port needs a number from 0 to 65535";
                    port = Some(number.ok_or_else(|| Error::Usage(String::from(wrong)))?);
                }
                "--no-serve" => serve = false,
                "--small" => small = true,
                _ => return Err(Error::Usage(format!("play has no option `{word}`"))),
            }
        }
        Ok(Options { port, serve, small })
    }
}

/// Builds the page and serves it until Ctrl+C.
pub(crate) fn run(repo: &Repo, console: &Console, options: &Options) -> Result<()> {
    let started = Instant::now();
    if let Some(port) = options.port {
        serve::check(port)?;
    }
    if options.small {
        bundle::page(repo, console)?;
    } else {
        bundle::quick(repo, console)?;
    }
    say(&format!("\nReady after {}.", seconds(started.elapsed())));
    if options.serve {
        let server = Server::start(repo, options.port)?;
        say(&format!("The virtual encoder is at  {}", server.url));
        say("Ctrl+C stops it.");
        server.wait();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::Options;

    #[test]
    fn command_lines() {
        let parse = |line: &str| {
            let args: Vec<String> = line.split_whitespace().map(String::from).collect();
            Options::parse(&args).ok()
        };
        let options = |port, serve, small| Some(Options { port, serve, small });
        assert_eq!(parse(""), options(None, true, false));
        assert_eq!(parse("--port 9000"), options(Some(9000), true, false));
        assert_eq!(parse("--port=0 --no-serve"), options(Some(0), false, false));
        assert_eq!(parse("--small"), options(None, true, true));
        for wrong in ["--port", "--port x", "--port 70000", "--prot 1", "9000"] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
    }
}
