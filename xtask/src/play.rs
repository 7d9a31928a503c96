//! `cargo xtask play`: from a fresh clone to the page in the browser.

use std::time::Instant;

use crate::bundle;
use crate::console::{Console, say, seconds};
use crate::error::{Error, Result};
use crate::repo::Repo;
use crate::serve::Server;

/// The command line of `play`.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Options {
    port: Option<u16>,
    serve: bool,
}

impl Options {
    /// Reads the arguments after `play`.
    pub(crate) fn parse(args: &[String]) -> Result<Options> {
        let mut options = Options {
            port: None,
            serve: true,
        };
        let mut args = args.iter();
        while let Some(arg) = args.next() {
            match arg.split_once('=').unwrap_or((arg, "")) {
                ("--port", "") => options.port = Some(port(args.next())?),
                ("--port", value) => options.port = Some(port(Some(value))?),
                ("--no-serve", "") => options.serve = false,
                _ => return Err(Error::Usage(format!("play takes no `{arg}`"))),
            }
        }
        Ok(options)
    }
}

fn port(value: Option<impl AsRef<str>>) -> Result<u16> {
    value
        .as_ref()
        .and_then(|text| text.as_ref().parse().ok())
        .ok_or_else(|| Error::Usage(String::from("--port wants a number from 0 to 65535")))
}

/// Builds the page and serves it until Ctrl+C.
pub(crate) fn run(repo: &Repo, console: &Console, options: &Options) -> Result<()> {
    let started = Instant::now();
    // A port that is taken should be known before the build, not after it.
    let server = options
        .serve
        .then(|| Server::bind(repo.dist(), options.port))
        .transpose()?;
    bundle::page(repo, console)?;
    say(&format!("\nReady after {}.", seconds(started.elapsed())));
    let Some(server) = server else {
        return Ok(());
    };
    say(&format!("The virtual encoder is at  {}", server.url()));
    say("Ctrl+C stops it.");
    server.run();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::Options;

    fn parse(line: &str) -> Option<Options> {
        let args: Vec<String> = line.split_whitespace().map(String::from).collect();
        Options::parse(&args).ok()
    }

    #[test]
    fn command_lines() {
        let options = |port, serve| Some(Options { port, serve });
        assert_eq!(parse(""), options(None, true));
        assert_eq!(parse("--port 9000"), options(Some(9000), true));
        assert_eq!(parse("--port=0 --no-serve"), options(Some(0), false));
        for wrong in ["--port", "--port x", "--port 70000", "--prot 1", "9000"] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
    }
}
