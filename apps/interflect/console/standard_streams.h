#pragma once

namespace interflect::command {

/// Opens missing standard streams, so no file takes their place. Writing to a stdout that was closed fails.
void open_missing_standard_streams();

/// Flushes stdout. @throws std::runtime_error if any output could not be written.
void flush_stdout();

}  // namespace interflect::command
