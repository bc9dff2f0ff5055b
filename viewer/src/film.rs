//! A flight that was looked at from its beginning to its end, as the page opens it.
//!
//! | bytes | what |
//! | --- | --- |
//! | 0 | `LMPCFILM` |
//! | 8 | length of the text, u32, the lowest byte first |
//! | 12 | text (JSON): `scene`, `news`, `texts` |
//! | … | frames one after the other, in the form of the stream |

use serde::Serialize;

use crate::frame::Frame;
use crate::news::{Text, VehicleNews};
use crate::scene::Scene;

/// What a file in this form begins with.
const MAGIC: &[u8; 8] = b"LMPCFILM";

/// A whole flight.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Film {
    /// What stood still at its end.
    pub scene: Scene,
    /// What was said of vehicles, each from a time on.
    pub news: Vec<NewsFrom>,
    /// Lines for the pilot, the oldest first.
    pub texts: Vec<Text>,
    /// States at even times.
    pub frames: Vec<Frame>,
}

/// What is said of a vehicle from a time on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NewsFrom {
    /// Simulation time, s.
    pub time_s: f64,
    /// What.
    #[serde(flatten)]
    pub news: VehicleNews,
}

impl Film {
    /// The bytes that the page reads.
    pub fn encode(&self) -> Vec<u8> {
        let Self { scene, news, texts, frames } = self;
        let text = serde_json::json!({ "scene": scene, "news": news, "texts": texts }).to_string();
        let mut bytes = MAGIC.to_vec();
        bytes.extend((text.len() as u32).to_le_bytes());
        bytes.extend(text.as_bytes());
        bytes.extend(frames.iter().flat_map(Frame::encode));
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::{Film, Frame, NewsFrom, VehicleNews};

    #[test]
    fn a_film_has_the_form_that_its_table_says() {
        let news = VehicleNews { id: 3, mode: "Hold".to_owned(), faults: Vec::new() };
        let frame = Frame { time_s: 0.5, ..Frame::default() };
        let film = Film {
            news: vec![NewsFrom { time_s: 0.25, news }],
            frames: vec![frame.clone(), frame.clone()],
            ..Film::default()
        };
        let bytes = film.encode();
        let (head, rest) = bytes.split_at(12);
        assert_eq!(&head[..8], b"LMPCFILM");
        let length = u32::from_le_bytes(head[8..].try_into().expect("four bytes")) as usize;
        let text: serde_json::Value = serde_json::from_slice(&rest[..length]).expect("JSON");
        assert_eq!(
            text["news"][0],
            serde_json::json!({"time_s": 0.25, "id": 3, "mode": "Hold", "faults": []})
        );
        assert_eq!(rest[length..], [frame.encode(), frame.encode()].concat());
    }
}
