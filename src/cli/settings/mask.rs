//! Values as they are printed: in one line, without secrets.

const MASK: &str = "***";
/// Most characters of a value that are printed.
const LONGEST: usize = 200;
/// The prefix of an API key, and the fewest characters after it.
const KEY: (&str, usize) = ("stickslip_", 32);
/// The prefix of a hash, which is no secret, but of no use in the output.
const HASH: &str = "sha256:";
/// Parameters of a URL whose values are printed.
const PUBLIC_PARAMETERS: [&str; 6] =
    ["sslmode", "sslrootcert", "application_name", "connect_timeout", "target_session_attrs", "options"];

/// A value without the passwords and keys in it. A part that may be either is masked.
pub fn masked(value: &str) -> String {
    let masked = without_secrets(&without_parameters(&without_password(value)), KEY.0, KEY.1);
    let masked = without_secrets(&masked, HASH, 0);
    let short = masked.chars().take(LONGEST);
    short.map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}

/// `scheme://user:password@host`: up to the last @, because passwords with an unescaped @ are common.
fn without_password(value: &str) -> String {
    let Some((before, host)) = value.rsplit_once('@') else {
        return value.to_owned();
    };
    let scheme = before.find("://").map_or_else(|| before.find(':').map_or(0, |colon| colon + 1), |colon| colon + 3);
    match before[scheme..].split_once(':') {
        Some((user, _)) => format!("{}{user}:{MASK}@{host}", &before[..scheme]),
        None => value.to_owned(),
    }
}

/// `scheme://…?name=value`: masks all values but those of public parameters.
fn without_parameters(value: &str) -> String {
    let Some((before, parameters)) = value.split_once('?').filter(|(before, _)| before.contains("://")) else {
        return value.to_owned();
    };
    let parameters = parameters.split('&').map(|parameter| match parameter.split_once('=') {
        Some((name, _)) if !PUBLIC_PARAMETERS.contains(&name) => format!("{name}={MASK}"),
        _ => parameter.to_owned(),
    });
    format!("{before}?{}", parameters.collect::<Vec<_>>().join("&"))
}

/// Masks the letters and digits after each `prefix`, where there are at least so many.
fn without_secrets(value: &str, prefix: &str, least: usize) -> String {
    let mut parts = value.split(prefix);
    let mut masked = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|letter: char| !letter.is_ascii_alphanumeric()).unwrap_or(part.len());
        let shown = if end >= least { MASK } else { &part[..end] };
        masked.extend([prefix, shown, &part[end..]]);
    }
    masked
}

#[cfg(test)]
mod tests {
    use super::masked;

    #[test]
    fn secrets_are_masked_and_the_rest_is_not() {
        let key = format!("stickslip_{}", "0a".repeat(32));
        for (value, expected) in [
            ("sqlite:/data/a.db", "sqlite:/data/a.db"),
            ("postgres://me@host/db", "postgres://me@host/db"),
            ("postgres://me:pa@ss/wo:rd@host:1/db?sslmode=require", "postgres://me:***@host:1/db?sslmode=require"),
            ("postgres://host/db?user=me&password=secret", "postgres://host/db?user=***&password=***"),
            ("postgres:/me:secret@host", "postgres:/me:***@host"),
            ("127.0.0.1:8080", "127.0.0.1:8080"),
            ("bench:write:sha256:00ff,b:read:sha256:", "bench:write:sha256:***,b:read:sha256:***"),
            ("stickslip_keys.toml", "stickslip_keys.toml"),
            ("two\nlines", "two lines"),
            (&format!("a {key} b"), "a stickslip_*** b"),
        ] {
            assert_eq!(masked(value), expected);
        }
    }
}
