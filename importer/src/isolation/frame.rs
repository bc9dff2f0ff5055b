//! Messages in a stream: four bytes of length, then postcard.

use std::io::{self, Read, Write};

use serde::Serialize;
use serde::de::DeserializeOwned;

/// Longest message: a program that is not the host must not make us reserve memory for its length.
const LONGEST: usize = 64 << 20;

/// Writes a message with one call.
///
/// # Errors
/// Those of the stream.
pub(super) fn write(stream: &mut impl Write, message: &impl Serialize) -> io::Result<()> {
    let bytes = postcard::to_extend(message, vec![0; 4]).map_err(io::Error::other)?;
    let mut bytes = bytes;
    let length = u32::try_from(bytes.len().saturating_sub(4)).map_err(io::Error::other)?;
    if let Some(head) = bytes.get_mut(..4) {
        head.copy_from_slice(&length.to_le_bytes());
    }
    stream.write_all(&bytes)?;
    stream.flush()
}

/// Reads a message; `None` at the end of the stream.
///
/// # Errors
/// Those of the stream, and `InvalidData`.
pub(super) fn read<T: DeserializeOwned>(stream: &mut impl Read) -> io::Result<Option<T>> {
    let mut head = [0; 4];
    match stream.read_exact(&mut head) {
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
        other => other?,
    }
    let length = u32::from_le_bytes(head) as usize;
    if length > LONGEST {
        return Err(io::ErrorKind::InvalidData.into());
    }
    let mut bytes = vec![0; length];
    stream.read_exact(&mut bytes)?;
    postcard::from_bytes(&bytes).map(Some).map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::{read, write};
    use crate::isolation::protocol::{Request, Response};

    #[test]
    fn messages_arrive_one_after_the_other() {
        let mut bytes = Vec::new();
        let step = Request::Step { time_s: 0.1, step_s: 1e-3, reals: vec![1.5, -0.0], booleans: vec![true] };
        write(&mut bytes, &step).expect("written");
        write(&mut bytes, &Request::Finish).expect("written");
        let mut stream = bytes.as_slice();
        assert_eq!(read::<Request>(&mut stream).expect("a message"), Some(step));
        assert_eq!(read::<Request>(&mut stream).expect("a message"), Some(Request::Finish));
        assert_eq!(read::<Request>(&mut stream).expect("the end"), None);
    }

    #[test]
    fn what_is_no_message_is_an_error() {
        for bytes in [&b"\xff\xff\xff\xff"[..], b"\x02\x00\x00\x00\x00", b"\x01\x00\x00\x00\x09"] {
            assert!(read::<Response>(&mut &bytes[..]).is_err(), "{bytes:?}");
        }
    }
}
