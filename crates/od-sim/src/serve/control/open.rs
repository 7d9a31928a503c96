//! Opens the control socket, for this user only.

use std::io::ErrorKind;

use mio::net::TcpListener;

use super::address::ControlAddress;
use crate::serve::error::Error;
use crate::serve::links::listener::Listener;

/// An open control socket.
pub(in crate::serve) struct ControlSocket {
    /// Its address, with the real port number.
    pub(in crate::serve) address: ControlAddress,
    pub(in crate::serve) listener: Listener,
    /// Removes the path when it is dropped.
    pub(in crate::serve) file: Option<SocketFile>,
}

/// The path of a socket; dropping this value removes it.
pub(in crate::serve) struct SocketFile {
    #[cfg(unix)]
    path: std::path::PathBuf,
    /// Device and inode: another bench may have put its own socket there.
    #[cfg(unix)]
    file: (u64, u64),
}

/// Listens at an address.
///
/// # Errors
/// Another process listens there, other users could reach it, or the system refuses it.
pub(in crate::serve) fn listen(address: &ControlAddress) -> Result<ControlSocket, Error> {
    match address {
        #[cfg(unix)]
        ControlAddress::Unix(path) => unix::listen(path),
        #[cfg(not(unix))]
        ControlAddress::Unix(_) => {
            let why = "--control: this system has no Unix sockets; write tcp:127.0.0.1:PORT";
            Err(Error::Usage(why.into()))
        }
        ControlAddress::Tcp(address) => tcp(address),
    }
}

fn tcp(address: &str) -> Result<ControlSocket, Error> {
    let addresses = ControlAddress::own_addresses(address);
    let addresses = addresses.map_err(|why| Error::Usage(format!("--control: {why}")))?;
    let bound = std::net::TcpListener::bind(addresses.as_slice());
    let listener = bound.map_err(|error| {
        let free = "take any free port with `--control tcp:127.0.0.1:0`";
        Error::Failed(match error.kind() {
            ErrorKind::AddrInUse => format!("--control: {address} is in use; {free}"),
            _ => format!("--control: {address}: {error}; {free}"),
        })
    })?;
    listener.set_nonblocking(true)?;
    Ok(ControlSocket {
        address: ControlAddress::Tcp(listener.local_addr()?.to_string()),
        listener: Listener::Tcp(TcpListener::from_std(listener)),
        file: None,
    })
}

#[cfg(unix)]
mod unix {
    use std::fs;
    use std::io::{self, ErrorKind};
    use std::os::unix::fs::{FileTypeExt, MetadataExt};
    use std::os::unix::net::{UnixListener, UnixStream};

    use nix::sys::stat::{Mode, umask};

    use super::{ControlAddress, ControlSocket, Error, Listener, SocketFile};

    pub(super) fn listen(path: &std::path::Path) -> Result<ControlSocket, Error> {
        let shown = path.display();
        let failed = |why: String| Error::Failed(format!("--control: {shown} {why}"));
        let bound = match bind(path) {
            Err(error) if error.kind() == ErrorKind::AddrInUse => {
                make_room(path).map_err(failed)?;
                bind(path)
            }
            bound => bound,
        };
        let listener = bound.map_err(|error| {
            Error::Failed(format!(
                "--control: {shown}: {error}; give a path in a folder of your own, at most 100 \
                 characters long"
            ))
        })?;
        listener.set_nonblocking(true)?;
        let file = fs::symlink_metadata(path)?;
        let path = path.to_owned();
        Ok(ControlSocket {
            address: ControlAddress::Unix(path.clone()),
            listener: Listener::Unix(mio::net::UnixListener::from_std(listener)),
            file: Some(SocketFile {
                path,
                file: (file.dev(), file.ino()),
            }),
        })
    }

    /// Creates the socket with mode 0600 from the start.
    fn bind(path: &std::path::Path) -> io::Result<UnixListener> {
        let before = umask(Mode::S_IRWXG | Mode::S_IRWXO | Mode::S_IXUSR);
        let bound = UnixListener::bind(path);
        umask(before);
        bound
    }

    /// Removes the socket of a process that has ended.
    fn make_room(path: &std::path::Path) -> Result<(), String> {
        let there = fs::symlink_metadata(path).map_err(|error| format!("is in use: {error}"))?;
        if !there.file_type().is_socket() {
            return Err("is not a socket; give another path".into());
        }
        match UnixStream::connect(path) {
            Ok(stream) => Err(format!(
                "is in use by {}; give another path",
                owner(&stream)
            )),
            Err(error) if error.kind() == ErrorKind::ConnectionRefused => fs::remove_file(path)
                .map_err(|error| format!("is left of an ended process: {error}")),
            Err(error) => Err(format!("is in use: {error}; give another path")),
        }
    }

    #[cfg(target_os = "linux")]
    fn owner(stream: &UnixStream) -> String {
        use nix::sys::socket::{getsockopt, sockopt::PeerCredentials};

        let Ok(peer) = getsockopt(stream, PeerCredentials) else {
            return String::from("another process");
        };
        let pid = peer.pid();
        let name = fs::read_to_string(format!("/proc/{pid}/comm")).unwrap_or_default();
        match name.trim() {
            "" => format!("process {pid}"),
            name => format!("process {pid} ({name})"),
        }
    }

    #[cfg(not(target_os = "linux"))]
    fn owner(_: &UnixStream) -> String {
        String::from("another process")
    }

    impl Drop for SocketFile {
        fn drop(&mut self) {
            let is_own = |file: fs::Metadata| (file.dev(), file.ino()) == self.file;
            if fs::symlink_metadata(&self.path).is_ok_and(is_own) {
                let _ = fs::remove_file(&self.path);
            }
        }
    }
}
