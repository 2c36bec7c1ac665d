//! Where the resources of the FMU are: `fmuResourceLocation` in all the spellings that importers use.

use std::path::{Path, PathBuf};

/// The folder that a resource location names; `None` where it names none (empty, not a file).
///
/// Accepted: `file:/path`, `file:///path`, `file://localhost/path`, `file://host/share` (UNC),
/// `file:///C:/path`, percent-encoded bytes in any of them, and a plain path.
pub fn folder(location: &str) -> Option<PathBuf> {
    let location = location.trim();
    if location.is_empty() {
        return None;
    }
    let Some(rest) = strip_scheme(location) else {
        return (!location.contains("://")).then(|| PathBuf::from(location));
    };
    let path = match rest.strip_prefix("//") {
        Some(authority_and_path) => {
            let at = authority_and_path.find('/').unwrap_or(authority_and_path.len());
            let (host, path) = authority_and_path.split_at(at);
            if host.is_empty() || host.eq_ignore_ascii_case("localhost") {
                path.to_string()
            } else if is_drive(host) {
                authority_and_path.to_string() // file://C:/path, as some importers write it
            } else {
                format!("//{host}{path}")
            }
        }
        None => rest.to_string(),
    };
    let path = decode(&path);
    let drive = path.strip_prefix('/').filter(|rest| is_drive(rest));
    Some(PathBuf::from(drive.unwrap_or(&path)))
}

fn strip_scheme(location: &str) -> Option<&str> {
    let (scheme, rest) = location.split_at_checked(5)?;
    scheme.eq_ignore_ascii_case("file:").then_some(rest)
}

fn is_drive(text: &str) -> bool {
    let mut chars = text.chars();
    chars.next().is_some_and(|c| c.is_ascii_alphabetic()) && matches!(chars.next(), Some(':' | '|'))
}

/// Percent-decodes; what is no valid escape stays as it is.
fn decode(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut i = 0;
    while i < bytes.len() {
        let digits = bytes.get(i + 1..i + 3).filter(|h| h.iter().all(u8::is_ascii_hexdigit));
        let hex = digits.filter(|_| bytes[i] == b'%').and_then(|h| std::str::from_utf8(h).ok());
        match hex.and_then(|h| u8::from_str_radix(h, 16).ok()) {
            Some(byte) => {
                out.push(byte);
                i += 3;
            }
            None => {
                out.push(bytes[i]);
                i += 1;
            }
        }
    }
    String::from_utf8(out).unwrap_or_else(|_| text.to_string())
}

/// The file that `name` means: as it stands if absolute, else in the resources if it is there.
pub fn resolve(name: &str, resources: Option<&Path>) -> PathBuf {
    let path = PathBuf::from(name);
    match resources.map(|folder| folder.join(&path)) {
        Some(inside) if path.is_relative() && inside.exists() => inside,
        _ => path,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_resource_location_is_read_in_all_its_spellings() {
        // RFC 8089, and the spellings that importers are known to use.
        let cases = [
            ("file:/tmp/a/resources", "/tmp/a/resources"),
            ("file:///tmp/a/resources", "/tmp/a/resources"),
            ("FILE:///tmp/a/resources/", "/tmp/a/resources/"),
            ("file://localhost/tmp/a", "/tmp/a"),
            ("file:///tmp/my%20fmu", "/tmp/my fmu"),
            ("file:///tmp/Gl%C3%A4tte", "/tmp/Glätte"),
            ("file:///tmp/100%", "/tmp/100%"),
            ("file://server/share/a", "//server/share/a"),
            ("file:///C:/a/resources", "C:/a/resources"),
            ("file://C:/a", "C:/a"),
            ("/tmp/plain", "/tmp/plain"),
        ];
        for (location, path) in cases {
            assert_eq!(folder(location), Some(PathBuf::from(path)), "{location}");
        }
        assert_eq!(folder(""), None);
        assert_eq!(folder("https://somewhere/resources"), None);
    }
}
