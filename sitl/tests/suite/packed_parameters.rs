//! Parameters as a packed file by FTP, as PX4's own suite and MAVProxy read and write them.

use std::collections::BTreeMap;

use crate::common::ftp_client::{CREATE, Client, FAIL, PROTECTED, REMOVE, TERMINATE, WRITE};
use sitl::files::Disk;

const PATH: &str = "@PARAM/param.pck";

/// What the suite's reader makes of a file: type and bits by name. Each name has the beginning that it shares with the one before left out.
fn decoded(bytes: &[u8]) -> BTreeMap<String, (u8, u32)> {
    let with_defaults = bytes[..2] == 0x671c_u16.to_le_bytes();
    assert!(with_defaults || bytes[..2] == 0x671b_u16.to_le_bytes());
    let (mut found, mut name, mut at) = (BTreeMap::new(), String::new(), 6);
    while at < bytes.len() {
        if bytes[at] == 0 {
            at += 1;
            continue;
        }
        let (kind, shared, fresh) =
            (bytes[at] & 15, usize::from(bytes[at + 1] & 15), usize::from(bytes[at + 1] >> 4) + 1);
        let default = if bytes[at] >> 4 == 1 { 4 } else { 0 };
        assert!(with_defaults || default == 0);
        name = format!(
            "{}{}",
            &name[..shared],
            std::str::from_utf8(&bytes[at + 2..at + 2 + fresh]).expect("a name")
        );
        let value = bytes[at + 2 + fresh..at + 6 + fresh].try_into().expect("four bytes");
        found.insert(name.clone(), (kind, u32::from_le_bytes(value)));
        at += 6 + fresh + default;
    }
    found
}

/// A file as the suite writes it: the last number of its header is its length.
fn encoded(values: &[(&str, u8, [u8; 4])]) -> Vec<u8> {
    let mut body = Vec::new();
    for (name, kind, value) in values {
        body.extend([*kind, ((name.len() - 1) << 4) as u8]);
        body.extend(name.as_bytes());
        body.extend(value);
    }
    let header = [0x671b, values.len() as u16, 6 + body.len() as u16];
    header.into_iter().flat_map(u16::to_le_bytes).chain(body).collect()
}

fn write(client: &mut Client, bytes: &[u8]) -> Result<Vec<u8>, u8> {
    client.on(CREATE, PATH)?;
    for (part, chunk) in bytes.chunks(200).enumerate() {
        client.ask(WRITE, 200 * part as u32, chunk)?;
    }
    client.ask(TERMINATE, 0, &[])
}

/// Suite: "Parameters upload via MAVLink FTP", and that its reader finds what was written.
#[test]
fn what_is_written_is_set_when_the_file_is_closed() {
    let mut client = Client::of(Disk::default());
    let before = decoded(&client.read("/@PARAM/param.pck?withdefaults=1").expect("there"));
    assert!(before.len() > 100 && before["NAV_ACC_RAD"].0 == 4 && before["RTL_TYPE"].0 == 3);
    let bytes = encoded(&[("NAV_ACC_RAD", 4, 3.5_f32.to_le_bytes()), ("RTL_TYPE", 3, 1_i32.to_le_bytes())]);
    assert_eq!(write(&mut client, &bytes), Ok(Vec::new()), "{:?}", client.bench.texts());
    let after = decoded(&client.read(PATH).expect("there"));
    assert_eq!((after["NAV_ACC_RAD"].1, after["RTL_TYPE"].1), (3.5_f32.to_bits(), 1));
    assert_eq!(after.len(), before.len());
    assert_eq!(client.on(REMOVE, PATH), Err(PROTECTED));
    // The whole file, as it was read, is taken back.
    let whole = client.read(PATH).expect("there");
    assert_eq!(write(&mut client, &whole), Ok(Vec::new()), "{:?}", client.bench.texts());
}

#[test]
fn what_is_wrong_is_told_and_the_rest_is_set() {
    let mut client = Client::of(Disk::default());
    let bytes = encoded(&[("NO_SUCH", 4, 1_f32.to_le_bytes()), ("NAV_ACC_RAD", 4, 4.5_f32.to_le_bytes())]);
    assert_eq!(write(&mut client, &bytes), Err(FAIL));
    assert!(client.bench.texts().iter().any(|text| text.contains("NO_SUCH")), "{:?}", client.bench.texts());
    assert_eq!(decoded(&client.read(PATH).expect("there"))["NAV_ACC_RAD"].1, 4.5_f32.to_bits());
    for (wrong, reason) in [
        (b"param".to_vec(), "begins with 0x6170"),
        (bytes[..bytes.len() - 1].to_vec(), "parameter 2 of 2 is cut off or wrong"),
        (encoded(&[("NAV_ACC_RAD", 9, [0; 4])]), "parameter 1 of 1"),
    ] {
        assert_eq!(write(&mut client, &wrong), Err(FAIL), "{reason}");
        assert!(client.bench.texts().iter().any(|text| text.contains(reason)), "{:?}", client.bench.texts());
        client.bench.fly(1.1);
    }
}

/// The default of a changed value stands behind it, and nowhere else; parts make the whole.
#[test]
fn defaults_and_parts_are_there_for_who_asks() {
    let mut client = Client::of(Disk::default());
    let pack = |client: &mut Client, options: &str| client.read(&format!("{PATH}?{options}")).expect("there");
    let plain = pack(&mut client, "withdefaults=0");
    assert_eq!(pack(&mut client, "withdefaults=1")[2..], plain[2..], "nothing has been changed");
    let bytes = encoded(&[("NAV_ACC_RAD", 4, 3.5_f32.to_le_bytes())]);
    assert_eq!(write(&mut client, &bytes), Ok(Vec::new()));
    let whole = pack(&mut client, "withdefaults=1");
    assert_eq!(whole.len(), plain.len() + 4);
    let changed = [3.5_f32.to_le_bytes(), 2.0_f32.to_le_bytes()].concat();
    assert!(whole.windows(8).any(|window| window == changed));
    let all = decoded(&whole);
    let half = all.len() / 2;
    let mut parts = decoded(&pack(&mut client, &format!("withdefaults=1&start=0&count={half}")));
    assert_eq!(parts.len(), half);
    let rest = pack(&mut client, &format!("start={half}"));
    assert_eq!(usize::from(u16::from_le_bytes([rest[4], rest[5]])), all.len());
    parts.extend(decoded(&rest));
    assert_eq!(parts, all);
}
