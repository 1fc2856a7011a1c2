/* Servo pulses: one channel after another, each in a slot of its own, every 20 ms.
 *
 * Channels 0 to 5 are Arduino pins 2 to 7, channels 6 and 7 pins 8 and 9. */
#ifndef PULSES_H
#define PULSES_H

#include <stdbool.h>
#include <stdint.h>

/* Starts Timer1; no channel has pulses. */
void pulses_start(void);

/* Divides the 20 ms among this many channels, none of which may have pulses at the time. */
void pulses_divide(uint8_t channels);

/* Length of a slot in ticks of 1/2 us for so many channels. */
uint16_t slot_ticks(uint8_t channels);

/* True once for every slot that has begun; channel: whose slot comes next, to be set by then. Where that is late
 * the channel repeats its pulse. */
bool pulses_next_slot(uint8_t *channel);
bool pulses_slot_is_due(void);

/* The pulse of a channel from its next slot on, in 1/16 us; 0: none. Never outside the bounds compiled in. */
void pulses_set(uint8_t channel, uint16_t pulse);

#endif
