//! From the bytes of a file to its text: limits, encodings, lines, numbers.

use super::error::{SkeletonFileError, SkeletonFileErrorKind};

/// Largest file, in bytes, that is read as a skeleton: 1 GiB.
pub const MAX_FILE_BYTES: u64 = 1 << 30;

/// Longest word of a file that an error message quotes, in characters.
const MAX_QUOTE: usize = 40;

/// The text of a file, without a byte order mark.
pub(super) fn decode(bytes: &[u8]) -> Result<&str, SkeletonFileError> {
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(SkeletonFileErrorKind::TooLarge.into());
    }
    // UTF-32 begins with the mark of UTF-16, or in the other byte order with two zeros.
    if bytes.starts_with(&[0xFF, 0xFE])
        || bytes.starts_with(&[0xFE, 0xFF])
        || bytes.starts_with(&[0, 0, 0xFE, 0xFF])
    {
        return Err(SkeletonFileErrorKind::WideText.into());
    }
    let at = |offset: usize, kind| Err(SkeletonFileError::on_line(line_of(bytes, offset), kind));
    if let Some(zero) = bytes.iter().position(|&byte| byte == 0) {
        return at(zero, SkeletonFileErrorKind::Binary);
    }
    match str::from_utf8(bytes) {
        Ok(text) => Ok(text.strip_prefix('\u{FEFF}').unwrap_or(text)),
        Err(error) => at(error.valid_up_to(), SkeletonFileErrorKind::NotUtf8),
    }
}

/// The line, counted from 1, of the byte at `offset`.
fn line_of(bytes: &[u8], offset: usize) -> u64 {
    1 + LineBreaks(&bytes[..offset]).count() as u64
}

/// The lines of a text, each with its number from 1. A line ends in `\n`, `\r\n` or `\r`.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (u64, &str)> {
    let mut rest = Some(text);
    let next_line = move || {
        let text = rest?;
        let (line, after) = match LineBreaks(text.as_bytes()).next() {
            Some((end, start)) => (&text[..end], Some(&text[start..])),
            None => (text, None),
        };
        rest = after;
        Some(line)
    };
    (1..).zip(std::iter::from_fn(next_line))
}

/// The line breaks of a text, each as where its line ends and where the next one starts, counted from the
/// start of what is left of the text.
struct LineBreaks<'a>(&'a [u8]);

impl Iterator for LineBreaks<'_> {
    type Item = (usize, usize);

    fn next(&mut self) -> Option<(usize, usize)> {
        let end = self
            .0
            .iter()
            .position(|byte| matches!(byte, b'\n' | b'\r'))?;
        let is_pair = self.0[end..].starts_with(b"\r\n");
        let start = end + 1 + usize::from(is_pair);
        self.0 = &self.0[start..];
        Some((end, start))
    }
}

/// A finite number.
pub(super) fn number(text: &str, column: &'static str) -> Result<f64, SkeletonFileErrorKind> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(SkeletonFileErrorKind::Number {
            column,
            text: quote(text),
        }),
    }
}

/// A whole number; also one written as a decimal fraction, as in `12.0` or `1.2e1`.
pub(super) fn id(text: &str, column: &'static str) -> Result<i64, SkeletonFileErrorKind> {
    /// Above this not every whole number is an `f64`, so that a decimal fraction may not be what was meant.
    const MAX_EXACT: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;

    if let Ok(id) = text.parse::<i64>() {
        return Ok(id);
    }
    match text.parse::<f64>() {
        Ok(number) if number.fract() == 0.0 && number.abs() <= MAX_EXACT => Ok(number as i64),
        _ => Err(SkeletonFileErrorKind::Id {
            column,
            text: quote(text),
        }),
    }
}

/// A word of the file, for a message.
fn quote(word: &str) -> String {
    shorten(word, MAX_QUOTE)
}

/// The first characters of a text, without any that do not print.
pub(super) fn shorten(text: &str, max_characters: usize) -> String {
    let mut characters = text.chars();
    let mut short = String::new();
    for character in characters.by_ref().take(max_characters) {
        if character.is_control() {
            short.extend(character.escape_debug());
        } else {
            short.push(character);
        }
    }
    if characters.next().is_some() {
        short.push('…');
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kind_and_line(bytes: &[u8]) -> (SkeletonFileErrorKind, Option<u64>) {
        let error = decode(bytes).unwrap_err();
        (error.kind, error.line)
    }

    #[test]
    fn a_byte_order_mark_is_no_text() {
        assert_eq!(decode(b"\xEF\xBB\xBFabc"), Ok("abc"));
        assert_eq!(decode(b""), Ok(""));
    }

    #[test]
    fn other_encodings_and_binary_files_are_told_apart() {
        let wide = (SkeletonFileErrorKind::WideText, None);
        assert_eq!(kind_and_line(b"\xFF\xFE1\0"), wide);
        assert_eq!(kind_and_line(b"\xFE\xFF\x001"), wide);
        assert_eq!(kind_and_line(b"\0\0\xFE\xFF\0\0\x001"), wide);
        assert_eq!(
            kind_and_line(b"a\nb\0c"),
            (SkeletonFileErrorKind::Binary, Some(2))
        );
        assert_eq!(
            kind_and_line(b"# a\r\n# b\r\n# Ram\xF3n"),
            (SkeletonFileErrorKind::NotUtf8, Some(3))
        );
    }

    #[test]
    fn lines_end_in_any_of_the_three_ways() {
        let numbered: Vec<_> = lines("a\nb\r\nc\rd\n\ne").collect();
        let expected = [(1, "a"), (2, "b"), (3, "c"), (4, "d"), (5, ""), (6, "e")];
        assert_eq!(numbered, expected);
        assert_eq!(lines("").collect::<Vec<_>>(), [(1, "")]);
    }

    #[test]
    fn numbers_are_finite() {
        assert_eq!(number("-1.5e3", "x"), Ok(-1500.0));
        for bad in ["NaN", "inf", "1e400", "", "1,5", "0x10"] {
            assert!(number(bad, "x").is_err(), "{bad}");
        }
    }

    #[test]
    fn ids_are_whole_numbers_however_written() {
        assert_eq!(id("-1", "id"), Ok(-1));
        assert_eq!(id("12.0", "id"), Ok(12));
        assert_eq!(id("9223372036854775807", "id"), Ok(i64::MAX));
        for bad in ["1.5", "9223372036854775808", "1e300", "inf", "NaN", "", "a"] {
            assert!(id(bad, "id").is_err(), "{bad}");
        }
    }

    #[test]
    fn quotes_are_short_and_printable() {
        let long = "é".repeat(1000);
        assert_eq!(quote(&long).chars().count(), MAX_QUOTE + 1);
        assert_eq!(quote("a\u{7}\"b"), "a\\u{7}\"b");
    }
}
