// Goes through entries of a table one by one: looks whether a packet's entries are legal, writes them, wipes, or
// reads entries through one of the datapath's own ports, byte by byte.
`default_nettype none

module halfrow_table_port #(
    parameter ENTRY_BITS = 11,
    parameter TAPS = 7
) (
    input  wire                  clk,
    input  wire                  rst,
    input  wire                  start,       // pulse; what to do is stable from then on until `done`
    input  wire [1:0]            task_kind,   // TASK_...
    input  wire                  kernel,      // the table
    input  wire                  grid,        // entries are a grid's, not row factors; the table is the same
    input  wire                  port,        // of the kernel
    input  wire [ENTRY_BITS-1:0] first,
    input  wire [12:0]           count,
    output wire                  done,        // pulse
    output wire                  illegal,     // pulse instead of it: table_entry is no factor, or needs outer taps
    output wire                  advance,     // the packet's next byte is wanted
    input  wire [7:0]            packet_byte, // the one that was wanted a clock ago
    output wire                  byte_valid,
    output wire [7:0]            byte_read,
    input  wire                  byte_ready,

    output wire                  step_write,
    output wire                  node_write,
    output reg  [ENTRY_BITS-1:0] table_entry,
    output wire [79:0]           table_data,
    input  wire [24:0]           step_port,   // three clocks after table_entry
    input  wire [79:0]           node_port_0,
    input  wire [79:0]           node_port_1
);
    `include "halfrow_board.vh"
    localparam IDLE = 3'd0, NEXT = 3'd1, FETCH = 3'd2, TEST = 3'd3, ADDRESS = 3'd4, OFFER = 3'd5;

    localparam [3:0] NODE_BYTES = 4'd10;
    localparam [3:0] STEP_BYTES = 4'd4;

    reg [2:0] state;
    reg [3:0] place; // byte of the entry
    reg [12:0] left;
    reg [79:0] entry; // being written: the newest byte in [79:72]; whole, or being read: the first one in [7:0]
    reg of_nodes; // `kernel`, a clock later
    wire [3:0] size = of_nodes ? NODE_BYTES : STEP_BYTES;
    wire last_byte = place == (of_nodes ? NODE_BYTES - 4'd1 : STEP_BYTES - 4'd1);
    wire fetched = state == FETCH && place == NODE_BYTES;
    wire byte_taken = state == OFFER && byte_ready;
    wire entry_done = (state == TEST && !illegal) || (byte_taken && last_byte);

    assign done = state == NEXT && left == 13'd0;
    assign advance = state == FETCH && place < size;
    assign byte_valid = state == OFFER;
    assign byte_read = entry[7:0];

    // A step is shifted on without new bytes until it stands where a node would.
    wire step_zero = entry[23:0] == 24'd0;
    wire step_illegal = entry[31:25] != 7'd0 || (!grid && entry[24] != step_zero);
    wire node_illegal = TAPS == 5 && (entry[15:0] != 16'd0 || entry[79:64] != 16'd0);
    assign illegal = state == TEST && task_kind == TASK_CHECK && (of_nodes ? node_illegal : step_illegal);

    wire write = state == TEST && (task_kind == TASK_WRITE || task_kind == TASK_WIPE);
    assign step_write = write && !of_nodes;
    assign node_write = write && of_nodes;
    assign table_data = {entry[79:25], entry[24] || (task_kind == TASK_WIPE && !of_nodes), entry[23:0]};

    always @(posedge clk) begin
        of_nodes <= kernel;
        if (start && task_kind == TASK_WIPE) entry <= 80'd0;
        else if (state == ADDRESS) entry <= of_nodes ? port ? node_port_1 : node_port_0 : {55'd0, step_port};
        else if ((state == FETCH && place != 4'd0) || byte_taken) entry <= {packet_byte, entry[79:8]};
        if (start) begin
            table_entry <= first;
            left <= count;
        end else if (entry_done) begin
            table_entry <= table_entry + {{ENTRY_BITS - 1{1'b0}}, 1'b1};
            left <= left - 13'd1;
        end
    end

    always @(posedge clk) begin
        case (state)
            NEXT:
            if (left == 13'd0) state <= IDLE;
            else
                case (task_kind)
                    TASK_READ: state <= ADDRESS;
                    TASK_WIPE: state <= TEST;
                    default: state <= FETCH;
                endcase
            FETCH: if (fetched) state <= TEST;
            TEST: state <= illegal ? IDLE : NEXT;
            ADDRESS: if (place[1]) state <= OFFER;
            OFFER: if (entry_done) state <= NEXT;
            default: state <= IDLE;
        endcase
        if (start) state <= NEXT;
        if (rst) state <= IDLE;

        if (state == FETCH || (state == ADDRESS && !place[1]) || (byte_taken && !last_byte)) place <= place + 4'd1;
        else if (state != OFFER) place <= 4'd0;
    end
endmodule

`default_nettype wire
