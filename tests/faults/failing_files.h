// Calls on files that fail when a test wants them to, from within its own process. The library
// stands before the C library, by linking or by LD_PRELOAD.
#pragma once

// Counts from now on the calls that write, flush, resize, make, rename or remove a file whose name
// begins with `folder`, and does `fault` to one of them, "<what>@<number from 1 on>":
//   kill   the process ends by SIGKILL instead of the call
//   half   half of what is to be written is, then it ends; "kill" where nothing is written
//   short  half of what is to be written is, and the call says so
//   full   the same, and all calls behind it fail for want of space
//   eio    the call fails for a broken disk, those behind it don't
//   none   nothing
// Removals are counted, too, and don't fail. Each call that is not done as it should be is told on
// standard error: "failing_files: full@7, pwrite of /there/file". By LD_PRELOAD the two come from
// TROCAR_FAULT and TROCAR_FAULT_FOLDER.
extern "C" void fail_files(const char* fault, const char* folder);
// So far.
extern "C" int n_file_calls();
