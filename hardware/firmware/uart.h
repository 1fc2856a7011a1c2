/* The serial line, by interrupts both ways. */
#ifndef UART_H
#define UART_H

#include <stdbool.h>
#include <stdint.h>

#include "protocol.h"

void uart_start(void);

/* Takes the next byte received; false where there is none. A byte that found the buffer full is lost, which
 * the frame's CRC tells. */
bool uart_take(uint8_t *byte);
bool uart_has_byte(void);

/* The buffer for the next frame to be sent, once uart_is_idle(); uart_send() sends n bytes of it. */
bool uart_is_idle(void);
uint8_t *uart_frame(void);
void uart_send(uint8_t n);

#endif
