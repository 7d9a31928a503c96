-- A session with `odkit lsp` in Neovim: what a user does, and what the editor then has.
--
--     nvim --headless --clean -S neovim.lua
--
-- ODKIT is the program, ODKIT_FILE the file to edit, ODKIT_RECORD the file that takes the recording.
-- Every wait is for an event; one that does not come within a minute ends the session with exit code 1.

local record = assert(io.open(vim.env.ODKIT_RECORD, "w"))

local function say(text)
  record:write(text, "\n")
end

local function stop(why)
  say("! " .. why)
  record:close()
  vim.cmd("cquit 1")
end

local function await(what, condition)
  if not vim.wait(60000, condition, 20) then
    stop("waited in vain for " .. what)
  end
end

local SEVERITY = { "error", "warning", "remark", "hint" }

local function diagnostics()
  local all = vim.diagnostic.get(0)
  table.sort(all, function(a, b)
    return a.lnum < b.lnum or (a.lnum == b.lnum and a.code < b.code)
  end)
  return all
end

local function show_diagnostics()
  local all = diagnostics()
  if #all == 0 then
    say("no findings")
  end
  for _, one in ipairs(all) do
    local message = one.message:gsub("\n", "\n    ")
    say(("%d:%d: %s[%s] %s"):format(one.lnum + 1, one.col + 1, SEVERITY[one.severity], one.code, message))
  end
end

-- The cursor on the first place of a text; `offset` bytes behind its start.
local function go(text, offset)
  for number, line in ipairs(vim.api.nvim_buf_get_lines(0, 0, -1, false)) do
    local at = line:find(text, 1, true)
    if at then
      vim.api.nvim_win_set_cursor(0, { number, at - 1 + (offset or 0) })
      return
    end
  end
  stop("there is no " .. text)
end

local function lines(pattern)
  for number, line in ipairs(vim.api.nvim_buf_get_lines(0, 0, -1, false)) do
    if line:find(pattern) then
      say(("%4d  %s"):format(number, line))
    end
  end
end

-- Changes of the buffer by the server's edits.
local function changed(action)
  local tick = vim.b.changedtick
  action()
  await("an edit", function()
    return vim.b.changedtick > tick
  end)
end

-- The diagnostics after a change: those that are published with its version.
local published = 0
local handler = vim.lsp.handlers["textDocument/publishDiagnostics"]
local function on_diagnostics(...)
  published = published + 1
  return handler(...)
end

local function after_check(action)
  local before = published
  action()
  await("findings", function()
    return published > before
  end)
end

vim.ui.select = function(items, options, choose)
  local titles = vim.tbl_map(options.format_item or tostring, items)
  for _, title in ipairs(titles) do
    say("offered: " .. title)
  end
  choose(items[1], 1)
end

vim.cmd("edit " .. vim.fn.fnameescape(vim.env.ODKIT_FILE))
vim.bo.filetype = "eds"
local ended
local id = vim.lsp.start_client({
  name = "odkit",
  cmd = { vim.env.ODKIT, "lsp" },
  root_dir = vim.fn.fnamemodify(vim.env.ODKIT_FILE, ":h"),
  handlers = { ["textDocument/publishDiagnostics"] = on_diagnostics },
  on_exit = function(code)
    ended = code
  end,
})

say("# open thermometer.eds")
after_check(function()
  vim.lsp.buf_attach_client(0, id)
end)
show_diagnostics()

say("\n# hover over 0x20000010")
go("0x20000010", 4)
vim.lsp.buf.hover()
local function float()
  for _, window in ipairs(vim.api.nvim_list_wins()) do
    if vim.api.nvim_win_get_config(window).relative ~= "" then
      return window
    end
  end
end
await("a hover", float)
for _, line in ipairs(vim.api.nvim_buf_get_lines(vim.api.nvim_win_get_buf(float()), 0, -1, false)) do
  say(line == "" and "|" or "| " .. line)
end
vim.api.nvim_win_close(float(), true)

say("\n# quick fix at DataType:0x0006")
go("DataType:0x0006", 0)
after_check(function()
  changed(function()
    vim.lsp.buf.code_action()
  end)
end)
lines("^DataType.0x0006")
show_diagnostics()

say("\n# type: DefaultValue=30")
go("DefaultValue=300", 15)
after_check(function()
  vim.cmd("normal! x")
end)
show_diagnostics()

say("\n# completion behind AccessType=")
go("AccessType=rw", 11)
local answer = vim.lsp.buf_request_sync(0, "textDocument/completion", vim.lsp.util.make_position_params(), 60000)
local words = {}
for _, item in ipairs(answer[id].result.items) do
  table.insert(words, item.label)
end
say(table.concat(words, " "))

say("\n# go to the definition of 0x20000010")
go("0x20000010", 4)
local from = vim.api.nvim_win_get_cursor(0)[1]
vim.lsp.buf.definition()
await("a jump", function()
  return vim.api.nvim_win_get_cursor(0)[1] ~= from
end)
say(("%4d  %s"):format(vim.api.nvim_win_get_cursor(0)[1], vim.api.nvim_get_current_line()))

say("\n# rename 2000 to 2002")
after_check(function()
  changed(function()
    vim.lsp.buf.rename("2002")
  end)
end)
lines("200[02]")
show_diagnostics()

say("\n# break two lines, then source.fixAll")
after_check(function()
  local text = table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, false), "\n")
  text = text:gsub("AccessType=const\n", "AccessType:const\n")
  vim.api.nvim_buf_set_lines(0, 0, -1, false, vim.split(text, "\n"))
end)
show_diagnostics()
go("AccessType:const", 0)
after_check(function()
  changed(function()
    vim.lsp.buf.code_action({ only = { "source.fixAll" } })
  end)
end)
lines("const")
show_diagnostics()

say("\n# format")
vim.api.nvim_buf_set_lines(0, 0, 0, false, { "; a comment that stays" })
changed(function()
  vim.lsp.buf.formatting_sync({}, 60000)
end)
say(("%d lines"):format(vim.api.nvim_buf_line_count(0)))
for _, line in ipairs(vim.api.nvim_buf_get_lines(0, 0, 4, false)) do
  say("  " .. line)
end

say("\n# quit")
vim.lsp.stop_client(id)
await("the end of the server", function()
  return ended ~= nil
end)
say("the server ended with code " .. ended)
record:close()
vim.cmd("quitall!")
