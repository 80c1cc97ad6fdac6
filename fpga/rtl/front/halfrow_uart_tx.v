// Bytes to a serial line: eight bits, least significant first, no parity, one stop bit. No byte begins while CTS# is
// high.
`default_nettype none

module halfrow_uart_tx #(
    parameter DIVIDER = 8 // clocks a bit, 2 to 65535
) (
    input  wire       clk,
    input  wire       rst,
    input  wire       valid,
    input  wire [7:0] data,
    output wire       ready,
    input  wire       cts_n, // not synchronous to clk
    output wire       txd
);
    generate // what a build cannot have
        if (DIVIDER < 2 || DIVIDER > 65535) halfrow_illegal_DIVIDER is_2_to_65535 ();
    endgenerate

    localparam COUNT_BITS = DIVIDER <= 16 ? 4 : DIVIDER <= 256 ? 8 : 16;
    localparam [15:0] WHOLE = DIVIDER - 1;

    reg [8:0] shift = 9'h1ff; // the line rests high from the configuration on
    reg [COUNT_BITS-1:0] count;
    reg [3:0] bits; // still to be sent, that on the line included
    (* ASYNC_REG = "TRUE" *) reg [1:0] cts_near_n;

    wire free = bits == 4'd0;
    wire next = count == {COUNT_BITS{1'b0}};

    assign ready = free && !cts_near_n[1];
    assign txd = shift[0];

    always @(posedge clk) begin
        cts_near_n <= {cts_near_n[0], cts_n};
        count <= free || next ? WHOLE[COUNT_BITS-1:0] : count - 1'b1;
        if (free) begin
            if (valid && ready) begin
                shift <= {data, 1'b0};
                bits <= 4'd10;
            end
        end else if (next) begin
            shift <= {1'b1, shift[8:1]};
            bits <= bits - 4'd1;
        end else if (bits == 4'd1 && count == 1) begin
            bits <= 4'd0; // the clock in which the next byte is taken is the stop bit's last
        end
        if (rst) begin
            shift <= 9'h1ff;
            bits <= 4'd0;
            cts_near_n <= 2'b11;
        end
    end
endmodule

`default_nettype wire
