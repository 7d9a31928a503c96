//! `odkit lsp`: findings, fixes and explanations in an editor, over standard input and output.

mod frames;

use std::io::{self, StdoutLock, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, TryRecvError};
use std::{fs, thread};

use od_eds::Finding;
use od_lsp::{Finder, Host, Server};
use od_model::Refused;

use crate::config::Config;
use crate::failure::Failure;
use crate::network::Files;
use frames::Frame;

/// Language server for EDS, DCF and XDD files; an editor starts it (Language Server Protocol 3.17)
///
/// It reads messages from standard input and writes them to standard output. Settings come from
/// `odkit.toml`, as for `odkit check`. A comment `;odkit-base=my.eds` in an overlay names its base.
#[derive(clap::Args)]
#[command(after_help = "Exit codes: 0 after `shutdown` and `exit`, 1 otherwise")]
pub(crate) struct Args {
    /// Use standard input and output (the only way; editors pass it)
    #[arg(long)]
    stdio: bool,
    /// Process of the editor (the server ends with its input; editors pass it)
    #[arg(long = "clientProcessId", value_name = "PID", hide = true)]
    client: Option<u32>,
}

pub(crate) fn run(_: &Args) -> Result<(), Failure> {
    let (sender, receiver) = mpsc::channel();
    // The thread ends with its input, or with the process.
    thread::spawn(move || {
        let mut input = io::stdin().lock();
        loop {
            let frame = frames::read(&mut input).unwrap_or(Frame::End);
            let is_end = matches!(frame, Frame::End);
            if sender.send(frame).is_err() || is_end {
                break;
            }
        }
    });
    let mut server = Server::new(Box::new(Disk));
    let mut output = io::stdout().lock();
    let mut is_open = true;
    let mut is_idle = false;
    loop {
        // All waiting messages are read before the next step: a cancelled request gets no answer, and a
        // file is checked once for all its changes.
        let waiting = if is_idle && is_open {
            receiver.recv().map_err(|_| TryRecvError::Disconnected)
        } else {
            receiver.try_recv()
        };
        match waiting {
            Ok(Frame::Message(text)) => server.receive(&text),
            Ok(Frame::Broken(why)) => server.reject(&why),
            Ok(Frame::End) | Err(TryRecvError::Disconnected) if is_open => is_open = false,
            _ => {
                let worked = server.step();
                write(&mut server, &mut output)?;
                if let Some(code) = server.exit_code() {
                    return ended(code);
                }
                if !worked && !is_open {
                    return ended(server.end_of_input());
                }
                is_idle = !worked;
                continue;
            }
        }
        is_idle = false;
    }
}

fn ended(code: u8) -> Result<(), Failure> {
    match code {
        0 => Ok(()),
        code => Err(Failure::Reported(code)),
    }
}

/// Writes the messages of the server.
fn write(server: &mut Server, output: &mut StdoutLock<'_>) -> Result<(), Failure> {
    let mut wrote = false;
    while let Some(text) = server.poll() {
        write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
        wrote = true;
    }
    if wrote {
        output.flush()?;
    }
    Ok(())
}

/// Reads files from the disk.
struct Disk;

impl Host for Disk {
    fn read(&self, path: &str) -> Option<Vec<u8>> {
        fs::read(path).ok()
    }

    fn beside(&self, path: &str) -> Vec<String> {
        let Some(folder) = Path::new(path).parent() else {
            return Vec::new();
        };
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let mut paths: Vec<String> = entries
            .map(|entry| entry.path().display().to_string())
            .collect();
        paths.sort();
        paths
    }

    fn judge(&self, path: &str, findings: &mut Vec<Finding>) -> Result<(), Refused> {
        let config = Config::of(path).map_err(|failure| Refused::from(failure.to_string()))?;
        config.apply(path, findings);
        Ok(())
    }

    fn network<'a>(
        &'a self,
        path: &'a str,
        find: &'a dyn Fn(&str) -> Option<Vec<u8>>,
    ) -> Finder<'a> {
        let files = Files::default();
        let open = move |path: &Path| {
            // Without `.`, as the path of an open file.
            let path: PathBuf = path.components().collect();
            let bytes = path.to_str().and_then(find);
            bytes.ok_or_else(|| "it cannot be read".into())
        };
        Box::new(move |text| {
            // An editor opens other YAML files, too.
            let is_list = path.to_ascii_lowercase().ends_with(".cpj");
            if is_list || text.contains("dcf:") {
                files.findings(path, text, &open)
            } else {
                Vec::new()
            }
        })
    }
}
