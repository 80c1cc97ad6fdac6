// The asynchronous FIFO interface of an FT2232H or FT232H as a stream of bytes each way. The defaults keep the chip's
// times up to 100 MHz. One byte at a time is moved, in turns when both directions wait.
`default_nettype none

module halfrow_ft245 #(
    // clocks: QUIET 1 to 4095, the others 1 to 255
    parameter SETUP = 1,    // of data in front of WR#, 5 ns, and behind it
    parameter PULSE = 4,    // RD# or WR# low, 30 ns; read data is good 14 ns after RD# fell
    parameter RECOVER = 6,  // up to where RXF# and TXE# answer to the last byte: 14 ns and their synchroniser
    parameter QUIET = 1000, // without a byte to write before SIWU#: more than a run of 255 takes to be stuffed
    parameter STROBE = 32   // SIWU# low, 250 ns
) (
    input  wire       clk,
    input  wire       rst,
    input  wire       armed,            // low: the chip may be a UART whose pins drive against WR# and SIWU#

    input  wire       ft_rxf_n,         // not synchronous to clk
    input  wire       ft_txe_n,
    output reg        ft_rd_n = 1'b1,  // from the configuration on
    output reg        ft_wr_n = 1'b1,
    output reg        ft_siwu_n = 1'b1,
    output reg        ft_control_drive, // WR# and SIWU# are driven, otherwise left to their pull-ups
    input  wire [7:0] ft_data_in,
    output reg  [7:0] ft_data_out,
    output reg        ft_data_drive,

    output reg        rx_valid,
    output reg  [7:0] rx_data,
    input  wire       rx_ready,
    input  wire       tx_valid,
    input  wire [7:0] tx_data,
    output wire       tx_ready
);
    generate // what a build cannot have
        if (SETUP < 1 || SETUP > 255) halfrow_illegal_SETUP is_1_to_255 ();
        if (PULSE < 1 || PULSE > 255) halfrow_illegal_PULSE is_1_to_255 ();
        if (RECOVER < 1 || RECOVER > 255) halfrow_illegal_RECOVER is_1_to_255 ();
        if (QUIET < 1 || QUIET > 4095) halfrow_illegal_QUIET is_1_to_4095 ();
        if (STROBE < 1 || STROBE > 255) halfrow_illegal_STROBE is_1_to_255 ();
    endgenerate

    localparam IDLE = 3'd0, READ = 3'd1, OFFER = 3'd2, WRITE = 3'd3, KEEP = 3'd4, SEND = 3'd5, REST = 3'd6;

    localparam [7:0] SETUP_LAST = SETUP - 1;
    localparam [7:0] PULSE_LAST = PULSE - 1;
    localparam [7:0] RECOVER_LAST = RECOVER - 1;
    localparam [7:0] STROBE_LAST = STROBE - 1;

    localparam [11:0] QUIET_LAST = QUIET - 1;

    reg [2:0] state;
    reg [7:0] count;        // clocks of the state to come
    reg [11:0] quiet;       // clocks up to SIWU#
    reg unsent;             // bytes were written since SIWU# was last low
    reg reads_next;         // when both directions wait
    (* ASYNC_REG = "TRUE" *) reg [1:0] rxf_n, txe_n; // [1] is synchronous

    wire may_read = !rxf_n[1] && !rx_valid;
    wire may_write = !txe_n[1] && ft_control_drive;
    wire due = count == 8'd0;
    wire send = unsent && quiet == 12'd0;

    assign tx_ready = state == IDLE && may_write && !(may_read && reads_next);

    always @(posedge clk) begin
        rxf_n <= {rxf_n[0], ft_rxf_n};
        txe_n <= {txe_n[0], ft_txe_n};
        ft_control_drive <= armed && !rst;
        if (rst) {rxf_n, txe_n} <= 4'hf;
    end

    always @(posedge clk) begin
        count <= count - 8'd1;
        case (state)
            IDLE: begin
                if (tx_valid && tx_ready) begin
                    state <= OFFER;
                    count <= SETUP_LAST;
                end else if (send) begin
                    state <= SEND;
                    count <= STROBE_LAST;
                end else if (may_read) begin
                    state <= READ;
                    count <= PULSE_LAST;
                end
            end
            OFFER: if (due) begin
                state <= WRITE;
                count <= PULSE_LAST;
            end
            WRITE: if (due) begin
                state <= KEEP;
                count <= SETUP_LAST;
            end
            REST: if (due) state <= IDLE;
            default: if (due) begin
                state <= REST;
                count <= RECOVER_LAST;
            end
        endcase
        if (rst) state <= IDLE;
    end

    always @(posedge clk) begin
        ft_rd_n <= !(state == READ && !rst);
        ft_wr_n <= !(state == WRITE && !rst);
        ft_siwu_n <= !(state == SEND && !rst);
        ft_data_drive <= (state == OFFER || state == WRITE || state == KEEP) && !rst;
        if (tx_valid && tx_ready) ft_data_out <= tx_data;
    end

    always @(posedge clk) begin
        if (rx_ready) rx_valid <= 1'b0;
        if (state == REST && !ft_rd_n) begin
            rx_valid <= 1'b1;
            rx_data <= ft_data_in;
        end
        if (state == READ) reads_next <= 1'b0;
        if (state == OFFER) reads_next <= 1'b1;
        if (state == OFFER) unsent <= 1'b1;
        if (state == SEND) unsent <= 1'b0;
        if (tx_valid || state == OFFER) quiet <= QUIET_LAST;
        else if (quiet != 12'd0) quiet <= quiet - 12'd1;
        if (rst) begin
            rx_valid <= 1'b0;
            reads_next <= 1'b1;
            unsent <= 1'b0;
        end
    end
endmodule

`default_nettype wire
