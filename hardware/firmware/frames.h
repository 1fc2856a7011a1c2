/* Frames on the line: COBS(type, sequence number, payload, CRC-16) and a zero byte. No hardware in here. */
#ifndef FRAMES_H
#define FRAMES_H

#include <stdint.h>

/* CRC-16/CCITT-FALSE: polynomial 0x1021, from 0xFFFF, most significant bit first. */
uint16_t crc16(const uint8_t *bytes, uint8_t n);

/* Undoes COBS and the CRC in place, for what came before a delimiter. Length of type, sequence number and payload,
 * or 0 where it is no frame. */
uint8_t frame_decode(uint8_t *bytes, uint8_t n);

/* Appends the CRC to body (which has to have room for two bytes more) and writes the frame with its delimiter to
 * frame (n + 4 bytes). Its length. */
uint8_t frame_encode(uint8_t *body, uint8_t n, uint8_t *frame);

/* Words are little-endian. */
uint16_t get_word(const uint8_t *bytes);
void put_word(uint8_t *bytes, uint16_t word);
void put_long(uint8_t *bytes, uint32_t number);

#endif
