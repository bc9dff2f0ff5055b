//! The checksums of records.

/// A record with right checksums: each line ends with the CRC-32 of all bytes before it.
pub fn sealed(text: &str) -> String {
    let mut sealed = String::new();
    for line in text.lines() {
        let content = line.rsplit_once(' ').map_or(line, |(content, _)| content);
        sealed.push_str(&format!("{content} "));
        let checksum = crc32fast::hash(sealed.as_bytes());
        sealed.push_str(&format!("{checksum:08x}\n"));
    }
    sealed
}
