//! What the readers of all `*.ron` documents of the crate share.

use ron::Options;
use ron::error::SpannedError;
use ron::extensions::Extensions;

/// Options in which `parent: 0` stands for `parent: Some(0)`, and values are nested at most `recursion_limit` deep.
pub(crate) fn options(recursion_limit: usize) -> Options {
    Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME)
        .with_recursion_limit(recursion_limit)
}

/// Whether the parser had read all of `text` when it met the error.
pub(crate) fn reaches_end(error: &SpannedError, text: &str) -> bool {
    let end = error.span.end;
    let mut lines = text.split('\n').skip(end.line.saturating_sub(1));
    let line = lines.next().unwrap_or_default();
    let unread = line.chars().skip(end.col.saturating_sub(1));
    unread
        .chain(lines.flat_map(str::chars))
        .all(char::is_whitespace)
}
