//! A guard against request smuggling: heads that a proxy and this server might end in different places, or give different bodies.
//!
//! The HTTP library accepts some that the standard allows: lines that end in a line feed alone, a length beside a transfer
//! coding, the same length twice. The guard inspects the bytes of a head as they arrive, and such requests are refused.

use memchr::memchr;

/// Bytes of a line that identify the header.
const NAME: usize = 20;

/// Inspects heads, in whatever pieces they arrive.
#[derive(Debug, Default)]
pub struct RequestSmugglingGuard {
    /// The beginning of the line.
    name: [u8; NAME],
    /// Its length so far.
    length: usize,
    last: u8,
    /// Lines of this head so far.
    lines: usize,
    lengths: usize,
    codings: usize,
    hosts: usize,
    over: bool,
}

impl RequestSmugglingGuard {
    /// Inspects more bytes and returns what is wrong, if anything. Bytes after the head are ignored.
    pub fn inspect(&mut self, bytes: &[u8]) -> Option<&'static str> {
        let mut rest = bytes;
        while !rest.is_empty() && !self.over {
            let (piece, after) = rest.split_at(memchr(b'\n', rest).map_or(rest.len(), |place| place + 1));
            rest = after;
            if self.length < NAME {
                let (room, end) = (NAME - self.length, piece.len());
                let part = &piece[..room.min(end)];
                self.name[self.length..self.length + part.len()].copy_from_slice(part);
            }
            self.length += piece.len();
            let before = if let [.., before, _] = piece { *before } else { self.last };
            self.last = piece.last().copied().unwrap_or(self.last);
            if self.last == b'\n' {
                if before != b'\r' {
                    return Some("a line of the head ends in a line feed without a carriage return");
                }
                self.end_line();
                if self.lengths > 1 || self.codings > 1 || (self.lengths > 0 && self.codings > 0) {
                    return Some("the head gives the length of the body more than once");
                }
                if self.hosts > 1 {
                    return Some("the head names more than one host");
                }
            }
        }
        None
    }

    fn end_line(&mut self) {
        let line = &self.name[..self.length.min(NAME)];
        let named =
            |name: &str| line.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name.as_bytes()));
        if self.length == 2 {
            // Empty lines before the first do not count.
            self.over = self.lines > 0;
        } else {
            self.lengths += usize::from(named("content-length:"));
            self.codings += usize::from(named("transfer-encoding:"));
            self.hosts += usize::from(named("host:"));
            self.lines += 1;
        }
        (self.length, self.last) = (0, 0);
    }
}

#[cfg(test)]
mod tests {
    use super::RequestSmugglingGuard;

    #[test]
    fn only_ambiguous_heads_are_refused() {
        for (ambiguous, head) in [
            (true, "GET / HTTP/1.1\nHost: a\n\n"),
            (true, "GET / HTTP/1.1\r\nHost: a\n\r\n"),
            (true, "GET / HTTP/1.1\r\nHost: a\r\n\n"),
            (true, "POST / HTTP/1.1\r\nContent-Length: 5\r\ntransfer-encoding: chunked\r\n\r\n"),
            (true, "POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\nHost: a\r\nCONTENT-LENGTH: 5\r\n\r\n"),
            (true, "POST / HTTP/1.1\r\nContent-Length: 5\r\nContent-Length: 5\r\n\r\n"),
            (true, "GET / HTTP/1.1\r\nHost: a\r\nhost: b\r\n\r\n"),
            (false, "GET / HTTP/1.1\r\nHost: a\r\n\r\n"),
            (false, "\r\n\r\nGET / HTTP/1.1\r\nHost: a\r\n\r\n"),
            (false, "POST / HTTP/1.1\r\nContent-Length: 5\r\nX-Content-Length: 5\r\n\r\n\nhello\nhost:\nhost:\n"),
            (false, "POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n"),
        ] {
            let whole = RequestSmugglingGuard::default().inspect(head.as_bytes());
            assert_eq!(whole.is_some(), ambiguous, "{head}");
            // In whatever pieces.
            let mut bytewise = RequestSmugglingGuard::default();
            assert_eq!(head.as_bytes().chunks(1).find_map(|byte| bytewise.inspect(byte)), whole, "{head}");
        }
    }
}
