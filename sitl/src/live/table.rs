//! Whether a table (.csv) is a flight that the page can show: the page itself leaves out what it cannot read.

/// Columns that the page needs, by the names of the FMU's outputs. The first must not fall.
const NEEDED: [&str; 4] = ["time", "position.x", "position.y", "position.z"];

/// The cells of a line, as the page reads them.
fn cells(line: &str) -> impl Iterator<Item = &str> {
    line.split(',').map(|cell| {
        let cell = cell.trim();
        cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')).unwrap_or(cell)
    })
}

/// Where the needed columns are in the line of names.
fn columns(names: &str) -> Result<[usize; NEEDED.len()], String> {
    let known: Vec<&str> = cells(names).collect();
    let missing: Vec<&str> = NEEDED.into_iter().filter(|name| !known.contains(name)).collect();
    if missing.is_empty() {
        return Ok(NEEDED.map(|name| known.iter().position(|known| *known == name).unwrap_or_default()));
    }
    let remedy = if names.contains(';') || names.contains('\t') {
        "separate the columns by commas".to_owned()
    } else if names.is_empty() {
        "it is empty".to_owned()
    } else {
        format!("it has {}", shortened(names))
    };
    Err(format!("the flight has no column {}; {remedy}", missing.join(", ")))
}

/// A text that fits a line.
fn shortened(text: &str) -> String {
    const MOST: usize = 100;
    if text.chars().count() <= MOST {
        return text.to_owned();
    }
    text.chars().take(MOST).chain(['…']).collect()
}

/// The numbers of a line. Of a flight that has diverged, the last are NaN; of one that was broken off, the last are missing.
fn numbers(line: &str, columns: [usize; NEEDED.len()]) -> Result<[f64; NEEDED.len()], String> {
    let row: Vec<&str> = cells(line).collect();
    let mut numbers = [f64::NAN; NEEDED.len()];
    for ((name, column), number) in NEEDED.iter().zip(columns).zip(&mut numbers) {
        let cell = row.get(column).copied().unwrap_or_default();
        if !cell.is_empty() {
            *number =
                cell.parse().map_err(|_| format!("{name} is `{}`; it must be a number", shortened(cell)))?;
        }
    }
    Ok(numbers)
}

/// Says what is wrong with a table.
pub fn check(bytes: &[u8]) -> Result<(), String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "it is no text in UTF-8".to_owned())?;
    // Some programs begin files with a mark of the byte order.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
    let columns = columns(lines.next().map_or("", |(_, names)| names))?;
    let mut last: Option<f64> = None;
    for (number, line) in lines {
        let [time, ..] = numbers(line, columns).map_err(|reason| format!("line {number}: {reason}"))?;
        if let Some(last) = last.filter(|last| *last > time) {
            return Err(format!(
                "line {number}: the time falls from {last} s to {time} s; sort the rows by time"
            ));
        }
        if time.is_finite() {
            last = Some(time);
        }
    }
    last.map(|_| ()).ok_or_else(|| "the flight has no rows".to_owned())
}

#[cfg(test)]
mod tests {
    use super::check;

    #[test]
    fn tables_of_fmpy_pandas_and_spreadsheets_are_flights() {
        for table in [
            "\"time\",\"position.x\",\"position.y\",\"position.z\"\n0.0,0.0,0.0,0.0\n0.5,0,0,-1e-3\n0.5,0,0,0\n",
            ",time,position.x,armed,position.y,position.z\n0,0.0,1,True,2,3\n",
            "time,position.x,position.y,position.z\n0,0,0,0\n1,nan,NaN,-inf\n2,1,1",
            "\u{feff}time, position.x, position.y, position.z\r\n\r\n0, 0, 0, 0\r\n",
        ] {
            assert_eq!(check(table.as_bytes()), Ok(()), "{table}");
        }
    }

    #[test]
    fn what_is_no_flight_is_named_with_its_line() {
        const NAMES: &str = "time,position.x,position.y,position.z\n";
        for (table, message) in [
            (String::new(), "no column time, position.x, position.y, position.z; it is empty"),
            (
                "time,height\n0,1\n".to_owned(),
                "no column position.x, position.y, position.z; it has time,height",
            ),
            (NAMES.replace(',', ";"), "separate the columns by commas"),
            (NAMES.to_owned(), "the flight has no rows"),
            (format!("{NAMES}0,0,0,0\n1,0,up,0\n"), "line 3: position.y is `up`; it must be a number"),
            (format!("{NAMES}nan,0,0,0\n"), "the flight has no rows"),
            (format!("{NAMES}1,0,0,0\n0.5,0,0,0\n"), "line 3: the time falls from 1 s to 0.5 s"),
        ] {
            let said = check(table.as_bytes()).unwrap_err();
            assert!(said.contains(message), "{table}: {said}");
        }
        assert_eq!(check(b"\xff\xfe"), Err("it is no text in UTF-8".to_owned()));
    }
}
