//! A guard against request smuggling: heads that a proxy and this server might end in different places, or give
//! different bodies.
//!
//! The HTTP library accepts some that the standard allows: lines that end in a line feed alone, a length beside a
//! transfer coding, the same length twice, other codings below the chunks. The guard inspects the bytes of a head as
//! they arrive, and such requests are refused. It also tells where a sound head ends and how long its body is.

use memchr::memchr;

/// Bytes of a line that are kept: any name and value that the guard has to know.
const LINE: usize = 64;

/// The length of a body, as a sound head states it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyLength {
    /// So many bytes.
    Bytes(u64),
    /// Chunks, whose end is in themselves.
    Chunked,
}

/// Inspects heads, in whatever pieces they arrive.
#[derive(Debug, Default)]
pub struct RequestSmugglingGuard {
    /// The beginning of the line.
    line: Vec<u8>,
    length: usize,
    last: u8,
    /// Lines of this head so far.
    lines: usize,
    body: Option<BodyLength>,
}

impl RequestSmugglingGuard {
    /// Inspects more bytes. If the head ends in them: after how many of them, and the length of its body.
    ///
    /// # Errors
    /// What is wrong with the head.
    pub fn inspect(&mut self, bytes: &[u8]) -> Result<Option<(usize, BodyLength)>, &'static str> {
        let mut rest = bytes;
        while !rest.is_empty() {
            let (piece, after) = rest.split_at(memchr(b'\n', rest).map_or(rest.len(), |place| place + 1));
            rest = after;
            if self.length < LINE {
                self.line.reserve_exact(LINE - self.line.len());
                self.line.extend_from_slice(&piece[..piece.len().min(LINE - self.length)]);
            }
            self.length += piece.len();
            let before = if let [.., before, _] = piece { *before } else { self.last };
            self.last = piece.last().copied().unwrap_or(self.last);
            if self.last != b'\n' {
                continue;
            }
            if before != b'\r' {
                return Err("a line of the head ends in a line feed without a carriage return");
            }
            // Empty lines before the first do not count.
            if self.length > 2 {
                self.end_line()?;
            } else if self.lines > 0 {
                return Ok(Some((bytes.len() - rest.len(), self.body.unwrap_or(BodyLength::Bytes(0)))));
            }
            self.line.clear();
            (self.length, self.last) = (0, 0);
        }
        Ok(None)
    }

    fn end_line(&mut self) -> Result<(), &'static str> {
        self.lines += 1;
        let whole = self.length <= LINE;
        let body = if let Some(length) = self.value("content-length") {
            let digits = whole && length.iter().all(u8::is_ascii_digit);
            let number = std::str::from_utf8(length).ok().filter(|_| digits).and_then(|text| text.parse().ok());
            BodyLength::Bytes(number.ok_or("the length of the body is not a plain number")?)
        } else if let Some(coding) = self.value("transfer-encoding") {
            if !(whole && coding.eq_ignore_ascii_case(b"chunked")) {
                return Err("the body has a transfer coding other than `chunked`");
            }
            BodyLength::Chunked
        } else {
            return Ok(());
        };
        if self.body.replace(body).is_some() {
            return Err("the head gives the length of the body more than once");
        }
        Ok(())
    }

    /// The value of the header in this line, if it has this name.
    fn value(&self, name: &str) -> Option<&[u8]> {
        let (start, value) = self.line.split_at_checked(name.len())?;
        let value = value.strip_prefix(b":")?;
        start.eq_ignore_ascii_case(name.as_bytes()).then(|| value.trim_ascii())
    }
}

#[cfg(test)]
mod tests {
    use super::{BodyLength, RequestSmugglingGuard};

    #[test]
    fn only_ambiguous_heads_are_refused_and_others_end_where_they_do() {
        let spaces = " ".repeat(60);
        let bytes = |number| Some(BodyLength::Bytes(number));
        for (expected, head, after) in [
            (None, "GET / HTTP/1.1\nHost: a\n\n", ""),
            (None, "GET / HTTP/1.1\r\nHost: a\n\r\n", ""),
            (None, "GET / HTTP/1.1\r\nHost: a\r\n\n", ""),
            (None, "POST / HTTP/1.1\r\nContent-Length: 5\r\ntransfer-encoding: chunked\r\n\r\n", ""),
            (None, "POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\nHost: a\r\nCONTENT-LENGTH: 5\r\n\r\n", ""),
            (None, "POST / HTTP/1.1\r\nContent-Length: 5\r\nContent-Length: 5\r\n\r\n", ""),
            (None, "POST / HTTP/1.1\r\nTransfer-Encoding: gzip, chunked\r\n\r\n", ""),
            (None, "POST / HTTP/1.1\r\nContent-Length: +5\r\n\r\n", ""),
            (None, &format!("POST / HTTP/1.1\r\nContent-Length:{spaces}5\r\n\r\n"), ""),
            (None, &format!("POST / HTTP/1.1\r\nTransfer-Encoding: chunked{spaces}, gzip\r\n\r\n"), ""),
            (bytes(0), "GET / HTTP/1.1\r\nHost: a\r\n\r\n", "GET / HTTP/1.1\r\n\r\n"),
            (bytes(0), "\r\n\r\nGET / HTTP/1.1\r\nHost: a\r\n\r\n", ""),
            (bytes(5), "POST / HTTP/1.1\r\nContent-Length:5\r\nX-Content-Length: 6\r\n\r\n", "\nhello\nhost:\nhost:\n"),
            (
                Some(BodyLength::Chunked),
                "POST / HTTP/1.1\r\nTransfer-Encoding: Chunked \r\n\r\n",
                "2\r\n{}\r\n0\r\n\r\n",
            ),
        ] {
            let sent = [head, after].concat();
            let whole = RequestSmugglingGuard::default().inspect(sent.as_bytes());
            assert_eq!(whole.ok(), expected.map(|body| Some((head.len(), body))), "{head}");
            // In whatever pieces.
            let mut bytewise = RequestSmugglingGuard::default();
            let ends = |(index, byte): (usize, &u8)| match bytewise.inspect(&[*byte]) {
                Ok(None) => None,
                Ok(Some((_, body))) => Some(Ok((index + 1, body))),
                Err(fault) => Some(Err(fault)),
            };
            let end = sent.as_bytes().iter().enumerate().find_map(ends);
            assert_eq!(end.transpose(), whole, "{head}");
        }
    }
}
