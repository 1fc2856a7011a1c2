#include "record.h"

#include "frames.h"

#define BYTES 6

/* In memory that start-up code leaves alone. The CRC tells what was written from what memory happens to hold after
 * power came on, or after a reset in the midst of writing. */
static uint16_t session __attribute__((section(".noinit")));
static uint32_t keys __attribute__((section(".noinit")));
static uint16_t crc __attribute__((section(".noinit")));

static uint16_t crc_of_it(void)
{
    uint8_t bytes[BYTES];
    put_word(bytes, session);
    put_long(bytes + 2, keys);
    return crc16(bytes, BYTES);
}

void record_start(void)
{
    if (crc != crc_of_it())
        record_begin(0);
}

void record_begin(uint16_t of)
{
    session = of;
    keys = 0;
    crc = crc_of_it();
}

void record_played(uint8_t more)
{
    keys += more;
    crc = crc_of_it();
}

uint16_t record_session(void)
{
    return session;
}

uint32_t record_keys(void)
{
    return keys;
}
