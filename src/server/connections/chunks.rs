//! The end of a body in chunks (RFC 9112, section 7.1), so that what a client sends beyond it is not handed on.

/// Finds the end, in whatever pieces the body arrives.
#[derive(Debug)]
pub enum ChunkEnd {
    /// In the line with the size of a chunk: the size so far, and whether its digits have ended.
    Size(u64, bool),
    /// In a chunk with so many bytes to come, the end of its line among them.
    Data(u64),
    /// In the lines after the last chunk: whether the present one has a byte.
    Trailer(bool),
}

impl Default for ChunkEnd {
    fn default() -> Self {
        ChunkEnd::Size(0, false)
    }
}

impl ChunkEnd {
    /// After how many of these bytes the body ends, if it does.
    pub fn find(&mut self, bytes: &[u8]) -> Option<usize> {
        let mut at = 0;
        while let Some(&byte) = bytes.get(at) {
            at += 1;
            *self = match (&*self, byte) {
                (ChunkEnd::Data(left), _) => {
                    let part = usize::try_from(*left).unwrap_or(usize::MAX).min(bytes.len() - at + 1);
                    at += part - 1;
                    if part as u64 == *left { ChunkEnd::default() } else { ChunkEnd::Data(left - part as u64) }
                }
                (ChunkEnd::Size(0, _), b'\n') => ChunkEnd::Trailer(false),
                (ChunkEnd::Size(size, _), b'\n') => ChunkEnd::Data(size.saturating_add(2)),
                (ChunkEnd::Size(size, ended), _) => match char::from(byte).to_digit(16).filter(|_| !ended) {
                    Some(digit) => ChunkEnd::Size(size.saturating_mul(16).saturating_add(digit.into()), false),
                    None => ChunkEnd::Size(*size, true),
                },
                (ChunkEnd::Trailer(false), b'\n') => return Some(at),
                (ChunkEnd::Trailer(_), b'\n') => ChunkEnd::Trailer(false),
                (ChunkEnd::Trailer(has_bytes), _) => ChunkEnd::Trailer(*has_bytes || byte != b'\r'),
            };
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::ChunkEnd;

    #[test]
    fn the_end_is_found_in_whatever_pieces_the_body_arrives() {
        let bodies = [
            "0\r\n\r\n",
            "5\r\nhello\r\n0\r\n\r\n",
            "16; a=\"0\"\r\n0\r\n\r\n0\r\n\r\n 0\r\n\r\n0\r\n\r\n\n\r\n0\r\nx: 0\r\ny: 1\r\n\r\n",
        ];
        for body in bodies {
            let sent = format!("{body}0\r\n\r\nGET / HTTP/1.1\r\n\r\n");
            for piece in 1..=sent.len() {
                let (mut end, mut before) = (ChunkEnd::default(), 0);
                let found = sent.as_bytes().chunks(piece).find_map(|part| {
                    let found = end.find(part).map(|at| before + at);
                    before += part.len();
                    found
                });
                assert_eq!(found, Some(body.len()), "{body:?} in pieces of {piece}");
            }
            assert_eq!(ChunkEnd::default().find(&body.as_bytes()[..body.len() - 1]), None);
        }
    }
}
