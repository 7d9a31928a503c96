//! Reason why a subcommand fails, and the exit code that follows.

/// Reason why a subcommand did not do its work.
pub(crate) enum Failure {
    /// The request is not valid: exit code 2.
    Usage(String),
    /// The work failed, or its result is negative: exit code 1.
    Failed(String),
    /// The message was printed already; this is the exit code.
    Reported(u8),
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Usage(message) | Self::Failed(message) => f.write_str(message),
            Self::Reported(code) => write!(f, "exit code {code}"),
        }
    }
}

impl From<od_model::Refused> for Failure {
    fn from(refused: od_model::Refused) -> Self {
        Self::Usage(refused.into())
    }
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        Self::Failed(error.to_string())
    }
}

impl From<od_sim::serve::Error> for Failure {
    fn from(error: od_sim::serve::Error) -> Self {
        match error {
            od_sim::serve::Error::Usage(message) => Self::Usage(message),
            other => Self::Failed(other.to_string()),
        }
    }
}

impl From<od_tools::Error> for Failure {
    fn from(fault: od_tools::Error) -> Self {
        match fault {
            od_tools::Error::Usage(message) => Self::Usage(message),
            wrong @ (od_tools::Error::Filter { .. } | od_tools::Error::Case { .. }) => {
                Self::Usage(wrong.to_string())
            }
            other => Self::Failed(other.to_string()),
        }
    }
}

/// Error of the operating system as a clause.
pub(crate) fn read_error(error: &std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::NotFound => "it does not exist".into(),
        std::io::ErrorKind::PermissionDenied => "it cannot be read (permission denied)".into(),
        std::io::ErrorKind::IsADirectory => "it is a folder".into(),
        _ => format!("it cannot be read: {error}"),
    }
}
