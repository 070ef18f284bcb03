#pragma once

namespace interflect::command {

/// Opens those of stdin, stdout and stderr that the process was started without, so that no file takes their place.
/// What is written to a stdout that was closed fails.
void open_missing_standard_streams();

/// Writes out what is left for stdout. @throws std::runtime_error where something could not be written.
void flush_stdout();

}  // namespace interflect::command
