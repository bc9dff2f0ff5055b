/* The logger that FMUs call: it writes the arguments into the message and hands the text to Rust.
 *
 * fmi2CallbackLogger has a variable number of arguments; stable Rust cannot define such a function. */
#include <stdarg.h>
#include <stdio.h>

/* Characters of the longest message, with the zero at its end; what is longer is cut. */
enum { LONGEST = 4096 };

extern void importer_take_message(void *environment, int status, const char *category, const char *text);

void importer_logger(void *environment, const char *instance, int status, const char *category, const char *format, ...)
{
    char text[LONGEST];
    int length = -1;
    (void)instance;
    if (format) {
        va_list arguments;
        va_start(arguments, format);
        length = vsnprintf(text, sizeof text, format, arguments);
        va_end(arguments);
    }
    /* What vsnprintf refuses is shown as it came. */
    importer_take_message(environment, status, category, length < 0 ? format : text);
}

/* What an FMU prints is seen line by line: the last line before a crash is the one that tells why. */
void importer_buffer_lines(void)
{
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
}
