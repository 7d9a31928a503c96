//! Interface of the server to the world outside: files, and the settings of a project.

use od_eds::Finding;
use od_model::Refused;

/// Finds the faults of a text.
pub type Finder<'a> = Box<dyn Fn(&str) -> Vec<Finding> + 'a>;

/// The world around a server.
pub trait Host {
    /// The bytes of a file; `None` if it cannot be read.
    fn read(&self, path: &str) -> Option<Vec<u8>>;

    /// The names of the files beside a file, with their paths.
    fn beside(&self, path: &str) -> Vec<String>;

    /// Removes findings of rules that the project switches off, and sets the severity of the others.
    ///
    /// # Errors
    /// The error in the project's settings; the findings are then unchanged.
    fn judge(&self, path: &str, findings: &mut Vec<Finding>) -> Result<(), Refused>;

    /// Returns what finds the faults of a project or a node list with a text; `find` gives the bytes of the files that it
    /// names, and each file is read once. A host without networks finds nothing.
    fn network<'a>(
        &'a self,
        _path: &'a str,
        _find: &'a dyn Fn(&str) -> Option<Vec<u8>>,
    ) -> Finder<'a> {
        Box::new(|_| Vec::new())
    }
}

/// A host without files and settings.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoHost;

impl Host for NoHost {
    fn read(&self, _: &str) -> Option<Vec<u8>> {
        None
    }

    fn beside(&self, _: &str) -> Vec<String> {
        Vec::new()
    }

    fn judge(&self, _: &str, _: &mut Vec<Finding>) -> Result<(), Refused> {
        Ok(())
    }
}
