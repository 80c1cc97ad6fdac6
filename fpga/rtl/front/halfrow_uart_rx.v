// Serial line to bytes: eight bits, least significant first, no parity, one stop bit. A byte without its stop bit is
// dropped.
`default_nettype none

module halfrow_uart_rx #(
    parameter DIVIDER = 8 // clocks a bit, 6 to 65535
) (
    input  wire       clk,
    input  wire       rst,
    input  wire       rxd,          // not synchronous to clk
    output reg        valid,        // pulse: a byte came
    output reg  [7:0] data,
    output reg        framing_error // pulse: one was dropped
);
    generate // what a build cannot have
        if (DIVIDER < 6 || DIVIDER > 65535) halfrow_illegal_DIVIDER is_6_to_65535 ();
    endgenerate

    localparam IDLE = 2'd0, START = 2'd1, BITS = 2'd2, BROKEN = 2'd3;

    localparam COUNT_BITS = DIVIDER <= 16 ? 4 : DIVIDER <= 256 ? 8 : 16;
    localparam [15:0] HALF = DIVIDER / 2 - 1;
    localparam [15:0] WHOLE = DIVIDER - 1;

    reg [1:0] state;
    (* ASYNC_REG = "TRUE" *) reg [4:0] history; // [1:0] synchronise, [4:2] vote, so that one clock of noise is not seen
    reg line;
    reg [COUNT_BITS-1:0] count;
    reg [3:0] bits; // that came

    wire look = count == {COUNT_BITS{1'b0}};

    always @(posedge clk) begin
        history <= {history[3:0], rxd};
        line <= (history[4] && history[3]) || (history[3] && history[2]) || (history[4] && history[2]);
        if (rst) {line, history} <= 6'h3f;
    end

    always @(posedge clk) begin
        valid <= 1'b0;
        framing_error <= 1'b0;
        count <= look ? WHOLE[COUNT_BITS-1:0] : count - 1'b1;
        case (state)
            IDLE: begin
                count <= HALF[COUNT_BITS-1:0];
                bits <= 4'd0;
                if (!line) state <= START;
            end
            START: if (look) state <= line ? IDLE : BITS;
            BITS: if (look) begin
                bits <= bits + 4'd1;
                if (bits != 4'd8) data <= {line, data[7:1]};
                else begin
                    valid <= line;
                    framing_error <= !line;
                    state <= line ? IDLE : BROKEN;
                end
            end
            default: if (line) state <= IDLE;
        endcase
        if (rst) begin
            state <= IDLE;
            valid <= 1'b0;
            framing_error <= 1'b0;
        end
    end
endmodule

`default_nettype wire
