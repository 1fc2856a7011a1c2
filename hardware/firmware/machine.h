/* The states of the arm, and what every frame does to them: PROTOCOL.md in C. */
#ifndef MACHINE_H
#define MACHINE_H

#include <stdbool.h>
#include <stdint.h>

void machine_start(void);

/* A frame came in: type, sequence number and payload, n bytes. */
void machine_receive(const uint8_t *body, uint8_t n);

/* Something came in that was no frame. */
void machine_receive_damaged(void);

/* A slot began: move on, and set the pulse of the channel whose slot is the next. */
void machine_slot(uint8_t channel);

/* Whether the host is to be told something; and the next frame that does, without its CRC. Its length. */
bool machine_has_answer(void);
uint8_t machine_answer(uint8_t *body);

#endif
