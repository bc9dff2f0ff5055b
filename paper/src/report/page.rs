//! A page under way.

use std::fmt::Write;

use crate::figures::Figure;

const STYLE: &str = "body{font-family:sans-serif;max-width:70rem;margin:2rem auto;padding:0 1rem;line-height:1.5;color:#222}\
    table{border-collapse:collapse;margin:1rem 0;font-size:.9rem}\
    td,th{border:1px solid #ccc;padding:.2rem .6rem;text-align:right}\
    th{background:#f4f4f4}td:first-child,th:first-child{text-align:left}\
    table.text td{text-align:left;vertical-align:top}\
    .scroll{overflow-x:auto}.figures{display:flex;flex-wrap:wrap}\
    figure{margin:0 1rem 1rem 0}figure svg{max-width:100%;height:auto}\
    figcaption{font-size:.9rem;color:#444;max-width:60rem}\
    h2{margin-top:2.5rem;border-bottom:1px solid #ddd}";

/// HTML, and the figures in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    body: String,
    title: String,
    contents: Vec<String>,
    figures: Vec<Figure>,
}

impl Page {
    /// An empty page.
    pub fn new(title: &str) -> Self {
        Self { body: String::new(), title: title.to_owned(), contents: Vec::new(), figures: Vec::new() }
    }

    fn write(&mut self, arguments: std::fmt::Arguments<'_>) {
        // Writing to a string does not fail.
        let _ = self.body.write_fmt(arguments);
    }

    /// A section begins.
    pub fn heading(&mut self, text: &str) {
        self.contents.push(text.to_owned());
        let number = self.contents.len();
        self.write(format_args!("<h2 id=\"section-{number}\">{text}</h2>\n"));
    }

    /// A part of a section begins.
    pub fn subheading(&mut self, text: &str) {
        self.write(format_args!("<h3>{text}</h3>\n"));
    }

    /// A paragraph of HTML.
    pub fn paragraph(&mut self, html: &str) {
        self.write(format_args!("<p>{html}</p>\n"));
    }

    /// A table of numbers.
    pub fn table(&mut self, header: &[&str], rows: &[Vec<String>]) {
        self.classed_table("", header, rows);
    }

    /// A table of sentences.
    pub fn text_table(&mut self, header: &[&str], rows: &[Vec<String>]) {
        self.classed_table(" class=\"text\"", header, rows);
    }

    fn classed_table(&mut self, class: &str, header: &[&str], rows: &[Vec<String>]) {
        self.write(format_args!("<div class=\"scroll\"><table{class}><tr>"));
        for cell in header {
            self.write(format_args!("<th>{cell}</th>"));
        }
        self.write(format_args!("</tr>\n"));
        for row in rows {
            self.write(format_args!("<tr>"));
            for cell in row {
                self.write(format_args!("<td>{cell}</td>"));
            }
            self.write(format_args!("</tr>\n"));
        }
        self.write(format_args!("</table></div>\n"));
    }

    /// Figures beside one another.
    pub fn figures(&mut self, figures: Vec<Figure>) {
        self.write(format_args!("<div class=\"figures\">\n"));
        for figure in figures {
            self.write(format_args!(
                "<figure>{}<figcaption>{}</figcaption></figure>\n",
                figure.svg, figure.caption
            ));
            self.figures.push(figure);
        }
        self.write(format_args!("</div>\n"));
    }

    /// The figures so far.
    pub fn all_figures(&self) -> &[Figure] {
        &self.figures
    }

    /// The finished page.
    pub fn html(&self) -> String {
        let contents: String = self
            .contents
            .iter()
            .enumerate()
            .map(|(index, text)| format!("<li><a href=\"#section-{}\">{text}</a></li>", index + 1))
            .collect();
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>\n<style>{STYLE}</style>\
             </head><body>\n<h1>{0}</h1>\n<ol>{contents}</ol>\n{1}</body></html>\n",
            self.title, self.body
        )
    }
}

/// A share above 1 as a percentage: 1.0042 is "0.42 %".
pub fn percent(ratio: Option<f64>) -> String {
    match ratio.map(|ratio| 100.0 * (ratio - 1.0)) {
        Some(percent) if percent.abs() >= 10.0 => format!("{percent:.0} %"),
        // Rounding of the optimum; nothing is better than it.
        Some(percent) if percent.abs() < 0.005 => "0.00 %".to_owned(),
        Some(percent) => format!("{percent:.2} %"),
        None => "refused".to_owned(),
    }
    .replace('-', "−")
    .replace(' ', "\u{a0}")
}
