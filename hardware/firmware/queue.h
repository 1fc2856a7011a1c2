/* Key frames waiting to be played. What a key frame takes depends on the number of channels: 64 of them fit for up
 * to five, 42 for eight. */
#ifndef QUEUE_H
#define QUEUE_H

#include <stdbool.h>
#include <stdint.h>

/* Empties it, for key frames of so many channels. */
void queue_clear(uint8_t channels);

uint8_t queue_free(void);
bool queue_is_empty(void);

/* The duration of all that is queued, in 0.1 ms. */
uint32_t queue_duration(void);

/* Appends a key frame as it is on the line: the duration, then a target for every channel. There has to be room. */
void queue_append(const uint8_t *key);

/* The first key frame: duration in 0.1 ms, then targets in 1/16 us. */
const uint16_t *queue_first(void);
void queue_drop_first(void);

#endif
