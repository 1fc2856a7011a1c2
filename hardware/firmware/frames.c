#include "frames.h"

uint16_t crc16(const uint8_t *bytes, uint8_t n)
{
    uint16_t crc = 0xFFFF;
    while (n--) {
        /* A byte at a time without a table: the polynomial has four terms. */
        uint8_t x = (uint8_t)(crc >> 8) ^ *bytes++;
        x ^= x >> 4;
        crc = (uint16_t)((crc << 8) ^ ((uint16_t)x << 12) ^ ((uint16_t)x << 5) ^ x);
    }
    return crc;
}

uint8_t frame_decode(uint8_t *bytes, uint8_t n)
{
    uint8_t from = 0, to = 0;
    while (from < n) {
        uint8_t code = bytes[from++]; /* how far the next zero is */
        if (code == 0 || (uint8_t)(code - 1) > n - from)
            return 0;
        while (--code)
            bytes[to++] = bytes[from++];
        if (from < n)
            bytes[to++] = 0;
    }
    if (to < 4 || crc16(bytes, to - 2) != get_word(bytes + to - 2))
        return 0;
    return to - 2;
}

uint8_t frame_encode(uint8_t *body, uint8_t n, uint8_t *frame)
{
    uint8_t code = 0, to = 1; /* a frame is shorter than 254 bytes: no run without a zero is too long for one code */
    put_word(body + n, crc16(body, n));
    n += 2;
    for (uint8_t from = 0; from < n; from++) {
        if (body[from]) {
            frame[to++] = body[from];
        } else {
            frame[code] = to - code;
            code = to++;
        }
    }
    frame[code] = to - code;
    frame[to++] = 0;
    return to;
}

uint16_t get_word(const uint8_t *bytes)
{
    return (uint16_t)(bytes[0] | (uint16_t)bytes[1] << 8);
}

void put_word(uint8_t *bytes, uint16_t word)
{
    bytes[0] = (uint8_t)word;
    bytes[1] = (uint8_t)(word >> 8);
}

void put_long(uint8_t *bytes, uint32_t number)
{
    put_word(bytes, (uint16_t)number);
    put_word(bytes + 2, (uint16_t)(number >> 16));
}
