//! The checksum of a frame: CRC-16/MCRF4XX.

/// x¹⁶ + x¹² + x⁵ + 1, the lowest power first.
const POLYNOMIAL: u16 = 0x8408;
/// Bytes that are taken in together.
const AT_ONCE: usize = 4;

/// What a byte makes of the checksum, with up to so many bytes that are zero behind it.
static TABLES: [[u16; 256]; AT_ONCE] = tables();

const fn tables() -> [[u16; 256]; AT_ONCE] {
    let mut tables = [[0; 256]; AT_ONCE];
    let mut index = 0;
    while index < 256 {
        let mut value = index as u16;
        let mut behind = 0;
        while behind < AT_ONCE {
            let mut bit = 0;
            while bit < 8 {
                value = if value & 1 == 1 { (value >> 1) ^ POLYNOMIAL } else { value >> 1 };
                bit += 1;
            }
            tables[behind][index] = value;
            behind += 1;
        }
        index += 1;
    }
    tables
}

/// The checksum of a frame without its marker, and of the seed of its message behind that.
///
/// Each byte would wait for the one before it; several that are looked up at once do not.
pub(super) fn frame_check(bytes: &[u8], extra: u8) -> u16 {
    let (together, rest) = bytes.as_chunks::<AT_ONCE>();
    let check = together.iter().fold(u16::MAX, |check, bytes| {
        let [low, high] = check.to_le_bytes();
        let [first, second, third, fourth] = *bytes;
        of_byte(3, low ^ first) ^ of_byte(2, high ^ second) ^ of_byte(1, third) ^ of_byte(0, fourth)
    });
    rest.iter().chain([&extra]).fold(check, |check, byte| {
        let [low, high] = check.to_le_bytes();
        u16::from(high) ^ of_byte(0, low ^ byte)
    })
}

/// What a byte makes of the checksum, with so many bytes behind it.
fn of_byte(behind: usize, byte: u8) -> u16 {
    TABLES[behind][usize::from(byte)]
}

#[cfg(test)]
mod tests {
    use mavlink::calculate_crc;

    use super::frame_check;

    #[test]
    fn it_is_that_of_the_dialect() {
        let bytes: Vec<u8> = (0..280_u32).map(|index| (index * 73).to_le_bytes()[0]).collect();
        for length in 0..bytes.len() {
            assert_eq!(frame_check(&bytes[..length], 39), calculate_crc(&bytes[..length], 39), "{length}");
        }
    }

    /// The published check value: that of "123456789".
    #[test]
    fn it_is_crc_16_mcrf4xx() {
        assert_eq!(frame_check(b"12345678", b'9'), 0x6f91);
    }
}
