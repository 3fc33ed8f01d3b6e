//! Values as they may be shown: in one line, and without secrets.

/// What stands in the place of a secret.
const MASK: &str = "***";
/// Characters of a value that are shown.
const LONGEST: usize = 200;
/// What a key for the service begins with, and the least that follows.
const KEY: (&str, usize) = ("stickslip_", 32);
/// Parameters of a URL whose values are no secrets.
const HARMLESS: [&str; 6] =
    ["sslmode", "sslrootcert", "application_name", "connect_timeout", "target_session_attrs", "options"];

/// A value without the passwords and keys in it. Rather too much is hidden than too little.
pub fn shown(value: &str) -> String {
    let masked = without_hashes(&without_keys(&without_parameters(&without_password(value))));
    let short = masked.chars().take(LONGEST);
    short.map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}

/// `scheme://user:password@host`: up to the last @, as people forget to encode theirs.
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

/// `scheme://…?name=value`: all values that are not known to be harmless.
fn without_parameters(value: &str) -> String {
    let Some((before, parameters)) = value.split_once('?').filter(|(before, _)| before.contains("://")) else {
        return value.to_owned();
    };
    let parameters = parameters.split('&').map(|parameter| match parameter.split_once('=') {
        Some((name, _)) if !HARMLESS.contains(&name) => format!("{name}={MASK}"),
        _ => parameter.to_owned(),
    });
    format!("{before}?{}", parameters.collect::<Vec<_>>().join("&"))
}

fn without_keys(value: &str) -> String {
    let (prefix, least) = KEY;
    let mut parts = value.split(prefix);
    let mut masked = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let key = part.find(|letter: char| !letter.is_ascii_alphanumeric()).unwrap_or(part.len());
        masked.push_str(prefix);
        masked.push_str(if key >= least { MASK } else { &part[..key] });
        masked.push_str(&part[key..]);
    }
    masked
}

/// A hash betrays nothing, but need not be shown either.
fn without_hashes(value: &str) -> String {
    let mut parts = value.split("sha256:");
    let mut masked = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        masked.push_str("sha256:");
        masked.push_str(MASK);
        masked.push_str(part.trim_start_matches(|letter: char| letter.is_ascii_alphanumeric()));
    }
    masked
}

#[cfg(test)]
mod tests {
    use super::shown;

    #[test]
    fn secrets_are_hidden_and_the_rest_is_not() {
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
            assert_eq!(shown(value), expected);
        }
    }
}
