/* Where in the queued key frames the arm is, and how fast it goes through them.
 *
 * Between two key frames a target goes in a straight line over the later one's duration. The time scale goes from
 * standing to full and back in a ramp, so that a hold brakes along the path. */
#ifndef PLAYHEAD_H
#define PLAYHEAD_H

#include <stdbool.h>
#include <stdint.h>

/* Stands at these pulses (1/16 us), from which the first key frame sets out. Key frames queued are forgotten. */
void playhead_place(const uint16_t *pulses, uint8_t channels);

/* The next move goes at the full time scale, without a ramp: for starts from rest. */
void playhead_start_at_once(void);

bool playhead_stands(void);

/* Ticks of queued motion that are left at the full time scale. */
uint32_t playhead_left(void);

/* Goes on by so many ticks of time, with the time scale on its way up (go) or down. Number of key frames whose end
 * was reached; these leave the queue. */
uint8_t playhead_move(uint16_t ticks, bool go);

/* The pulse of a channel here, in 1/16 us. */
uint16_t playhead_pulse(uint8_t channel);

#endif
