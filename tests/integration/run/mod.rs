//! Runs of the program: files, messages, exit statuses, interruptions, pages, films and sweeps.

mod command_line;
mod disturbed_runs;
mod files;
mod films;
mod pages;
mod resumed_paths;
mod runs;
mod several_scenes;
mod stopping;
mod sweep;
