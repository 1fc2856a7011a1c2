/* What the controller remembers of a run: whose it is, and how many of its key frames have been played.
 *
 * It outlives the host, and a reset too as long as there is power: a host that opens the line of an Arduino resets it,
 * and asks afterwards. */
#ifndef RECORD_H
#define RECORD_H

#include <stdint.h>

/* After a reset: what is not whole is forgotten. */
void record_start(void);

/* Another run begins. */
void record_begin(uint16_t session);

/* So many key frames more have been played to their end. */
void record_played(uint8_t keys);

uint16_t record_session(void); /* 0: nothing is remembered */
uint32_t record_keys(void);

#endif
