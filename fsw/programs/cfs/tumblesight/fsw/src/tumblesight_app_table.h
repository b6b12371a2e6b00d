/* The parameters and fault rules as a cFE table: struct tumblesight_parameters. */
#ifndef TUMBLESIGHT_APP_TABLE_H
#define TUMBLESIGHT_APP_TABLE_H

/* Registers the table and loads its file. If the file cannot be loaded, the initial parameters become the
 * table. Without a table the flight application keeps its parameters. */
void TUMBLESIGHT_APP_RegisterTable(void);

/* Carries out what the table services ask for. A new table is used from the next cycle on. */
void TUMBLESIGHT_APP_ManageTable(void);

#endif /* TUMBLESIGHT_APP_TABLE_H */
