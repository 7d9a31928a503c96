//! What a release needs.

use crate::console::cargo;
use crate::error::Result;
use crate::test::Context;

pub(super) fn package(context: &Context<'_>) -> Result<()> {
    let mut command = cargo(&context.repo.root, &["package", "--workspace"]);
    command.args(["--no-verify", "--allow-dirty", "--quiet"]);
    context.console.run("packages", &mut command)
}
