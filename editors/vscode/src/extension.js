// Starts `odkit lsp` and hands the editor's files to it. All that is known about CANopen is there.

"use strict";

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

/** The files that the server reads. */
function documents(settings) {
  const rust = settings.get("rust") ? [{ language: "rust", scheme: "file" }] : [];
  const networks = { scheme: "file", pattern: "**/bus.{yml,yaml}" };
  return [{ language: "eds" }, { language: "xdd" }, networks, ...rust];
}

async function start(context) {
  const settings = vscode.workspace.getConfiguration("odkit");
  const config = settings.get("config");
  const command = settings.get("path") || "odkit";
  const args = config ? ["lsp", "--config", config] : ["lsp"];
  client = new LanguageClient("odkit", "odkit", { command, args }, { documentSelector: documents(settings) });
  try {
    await client.start();
  } catch (error) {
    client = undefined;
    const open = "Open settings";
    const chosen = await vscode.window.showErrorMessage(
      `\`${command} lsp\` cannot be started (${error.message}). Install odkit, or set odkit.path.`,
      open,
    );
    if (chosen === open) {
      await vscode.commands.executeCommand("workbench.action.openSettings", "odkit.path");
    }
  }
}

async function stop() {
  const running = client;
  client = undefined;
  await running?.stop();
}

async function restart(context) {
  await stop();
  await start(context);
}

async function activate(context) {
  context.subscriptions.push(
    vscode.commands.registerCommand("odkit.restart", () => restart(context)),
    vscode.workspace.onDidChangeConfiguration((event) =>
      ["path", "config", "rust"].some((key) => event.affectsConfiguration(`odkit.${key}`)) ? restart(context) : undefined,
    ),
  );
  await start(context);
}

module.exports = { activate, deactivate: stop };
