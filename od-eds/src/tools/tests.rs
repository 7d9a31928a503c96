//! The rules of all tools against their own texts.

use super::*;
