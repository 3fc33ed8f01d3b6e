//! Vector pictures beside those that a person has looked at.

/// A text in pieces: numbers, and what lies between.
fn pieces(text: &str) -> Vec<&str> {
    let is_number = |letter: char| letter.is_ascii_digit() || letter == '.';
    let (mut pieces, mut rest) = (Vec::new(), text);
    while let Some(first) = rest.chars().next() {
        let end = rest.find(|letter| is_number(letter) != is_number(first)).unwrap_or(rest.len());
        let (piece, after) = rest.split_at(end);
        pieces.push(piece);
        rest = after;
    }
    pieces
}

/// What keeps a vector plot from being its reference: other words, another structure, or a number that is off by more
/// than `shift` pixels.
pub fn other_lines(found: &str, reference: &str, shift: f64) -> Option<String> {
    let (found, reference): (Vec<_>, Vec<_>) =
        (found.split_inclusive('>').collect(), reference.split_inclusive('>').collect());
    if found.len() != reference.len() {
        return Some(format!("{} parts, {} in the reference", found.len(), reference.len()));
    }
    let other = |(found, reference): &(&str, &str)| {
        // Outside a tag stand the words of the plot, with its numbers.
        let [(words, tag), (own, of)] = [found, reference].map(|part| part.rsplit_once('<').unwrap_or((part, "")));
        let (tag, of) = (pieces(tag), pieces(of));
        let same = |(one, two): (&&str, &&str)| match (one.parse::<f64>(), two.parse::<f64>()) {
            (Ok(one), Ok(two)) => (one - two).abs() <= shift,
            _ => one == two,
        };
        words != own || tag.len() != of.len() || !tag.iter().zip(&of).all(same)
    };
    let first = found.into_iter().zip(reference).find(other);
    first.map(|(found, reference)| format!("{found:.300}\nin place of\n{reference:.300}"))
}
